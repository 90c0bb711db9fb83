"""Do the tests notice? Faults put into the core one by one: named ones, and random ones made by a machine."""
