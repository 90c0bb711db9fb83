"""measure(what, method, numbers): what the program of this folder measures; built in the folder under test."""

import json
import subprocess

import pytest
from support.paths import build_target

METHODS = {"adams": 0, "bdf": 1, "runge_kutta": 2}


@pytest.fixture(scope="session")
def measure():
    program = build_target("solver_measure") / "tests" / "solver" / "solver_measure"

    def run(what, method="runge_kutta", *numbers):
        command = [str(program), what, str(METHODS[method]), *map(repr, numbers)]
        done = subprocess.run(command, capture_output=True, text=True, timeout=120)
        assert done.returncode == 0, f"{what}: {done.returncode} {done.stderr[-500:]}"
        assert done.stderr == ""
        return json.loads(done.stdout)

    return run


@pytest.fixture(params=METHODS)
def method(request):
    return request.param
