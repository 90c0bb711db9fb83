"""What every folder of tests shares: the fixtures of the built FMU, and --bounds."""

pytest_plugins = ["support.fixtures", "support.bounds"]
