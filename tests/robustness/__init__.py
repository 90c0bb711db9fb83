"""Hard use: stiff and extreme wheels, faults of memory, threads, the fuzzer of the C interface."""
