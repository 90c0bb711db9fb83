"""Runs a module of the package where it is not installed yet: python3 tools MODULE [ARGUMENT...]."""

import runpy
import sys

del sys.argv[0]
runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)
