"""Tests of the FMU's C interface: what a master may do, and what it must be told when it may not."""
