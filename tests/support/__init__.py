"""What the tests and the reports share: the FMU driver, scenes as data, closed forms, the C header through ctypes."""
