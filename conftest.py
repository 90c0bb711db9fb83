"""What every folder of tests shares: the fixtures of the built FMU, and the tables of bounds."""

pytest_plugins = ["support.fixtures", "support.bound_tables"]
