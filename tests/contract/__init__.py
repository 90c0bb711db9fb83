"""Tests of the FMU's C interface: what a master may do, and which message it gets where it may not."""
