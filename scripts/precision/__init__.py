"""Error against run time: the wheel's FMU and its peers on the same scenes, in one run (scripts/work_precision)."""
