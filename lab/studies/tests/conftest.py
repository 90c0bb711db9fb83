"""Workers, and small studies to run."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import xarray as xr
from distributed import LocalCluster
from fmpy import extract

from lab.studies import Study, compute
from lab.studies.dataset import axes_of, points, template
from lab.studies.names import variables_of
from lab.studies.worker import Instance, pack, run_block
from wheelfmu.fmu import values


@pytest.fixture(scope="session")
def alone(fmu_path: Path, tmp_path_factory: pytest.TempPathFactory) -> Callable[[Study], xr.Dataset]:
    """Runs a study by one instance in this process, one wheel after the other."""
    folder = extract(pack(fmu_path, tmp_path_factory.mktemp("fmu") / "wheel.zip"))
    variables, instance = variables_of(fmu_path), Instance(folder)

    def run(study: Study) -> xr.Dataset:
        study.check(variables)
        axes = axes_of(study)
        results = template(study, axes, variables, 1_000_000)
        found = run_block(instance, study, points(axes))
        assert found.keys() == results.keys()
        return results.assign({name: (results[name].dims, values) for name, values in found.items()})

    return run


@pytest.fixture(scope="session")
def crew() -> Iterator[LocalCluster]:
    """Two workers on this machine, for all tests of a process."""
    with compute.cluster(2) as workers:
        yield workers


@pytest.fixture(scope="session")
def conduct(fmu_path: Path, crew: LocalCluster, tmp_path_factory: pytest.TempPathFactory) -> Callable[..., xr.Dataset]:
    """Runs a study with the two workers, which do `work` with each chunk."""

    def conduct(study: Study, out: Path | str | None = None, work: object = compute.run_chunk, **how) -> xr.Dataset:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(compute, "run_chunk", work)
            return study.run(out or tmp_path_factory.mktemp("study") / "z", **{"fmu": fmu_path, "workers": crew} | how)

    return conduct
