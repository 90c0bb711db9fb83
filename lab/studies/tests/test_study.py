"""Studies with many workers: bit-identical to one, with a scheduler elsewhere, and in any file system."""

import re
import shlex
import subprocess
import sys
from contextlib import nullcontext
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from distributed import LocalCluster, SubprocessCluster
from support.bounds import EPSILON, absolute_error, beyond, relative_error, within

from lab.studies import Status, Study, StudyError, options, pictures
from lab.studies.__main__ import main, study_file
from lab.studies.dataset import in_degrees, study_of
from lab.studies.options import arguments_of, file_of
from wheelfmu.diagrams.style import save_png
from wheelfmu.fmu.paths import ROOT

from .studies_support import FATES, same

GUIDE = (ROOT / "lab" / "studies" / "README.md").read_text(encoding="utf-8")
EXAMPLE = re.findall(r"^```python\n(.*?)^```", GUIDE, re.MULTILINE | re.DOTALL)[0]


def test_the_guides_study_is_that_of_its_command_line(tmp_path: Path) -> None:
    file = tmp_path / "grid.py"
    file.write_text(EXAMPLE)
    study = study_file(file)["study"]
    words = shlex.split(re.search(r"scripts/study (--vary.*?)```", GUIDE, re.DOTALL)[1].replace("\\\n", " "))
    other = ["s=0.02" if word == "s=0.01" else word for word in words]
    assert arguments_of(words).study == study != arguments_of(other).study


def test_results_are_labelled_and_carry_all_that_repeats_them(conduct) -> None:
    results = conduct(FATES, chunk=4).load()
    assert {*results["theta"].sizes.items()} == {("theta_start", 3), ("s", 2), ("phi_dot_start", 4), ("time", 101)}
    assert set(results.attrs) >= {"fmu_sha256", "fmu_version", "fmu_guid", "numpy_version", "study"}
    begun = results.sel(theta_start=np.radians(75.0), s=0.03, phi_dot_start=-2.0)
    assert float(begun["theta"][0]) == np.radians(75.0)
    turned = in_degrees(results)
    assert (results["lowest"].attrs["units"], turned["lowest"].attrs["units"]) == ("rad", "deg")
    within(relative_error(turned["theta_start"].values, [15, 75, 200]), 16 * EPSILON, "theta_start in deg, relative")
    np.testing.assert_array_equal(turned["energy"], results["energy"])


def test_another_study_is_overwritten_on_request_and_nothing_else(conduct, tmp_path: Path) -> None:
    for s in (0.0, 0.01):
        assert conduct(Study(grid={"s": [s]}, stop_time=1.0), tmp_path / "z", overwrite=True)["s"].item() == s
    (tmp_path / "thesis.tex").write_text("years of work")
    with pytest.raises(StudyError, match="is not a Zarr group"):
        conduct(Study(grid={"s": [0.0]}), tmp_path, overwrite=True)
    assert (tmp_path / "thesis.tex").exists()


LISTED = Study(list={"s": np.linspace(0.0, 0.03, 50), "theta_start": np.linspace(1.2, 1.4, 50)}, stop_time=1.0)
WAYS = {
    "into a folder, by the URL of fsspec's local files": (FATES, "file://{folder}/z", False),
    "into the caller's memory": (FATES, "memory://{folder}/z", False),
    "on other machines, without this package": (FATES, "{folder}/z", True),
    "a list": (LISTED, "{folder}/z", False),
}


@pytest.mark.parametrize(("study", "place", "elsewhere"), WAYS.values(), ids=WAYS)
def test_results_are_bit_identical_wherever_they_are_run_and_written(
    study, place, elsewhere, alone, conduct, crew, tmp_path, monkeypatch
) -> None:
    """As those of one instance."""
    out = place.format(folder=tmp_path)
    places = {str(ROOT), str(ROOT / "tools")}
    away_from = f"import sys\nsys.path[:] = [x for x in sys.path if x not in {places}]\n"  # no package is installed
    (tmp_path / "sitecustomize.py").write_text(away_from)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    away = partial(SubprocessCluster, n_workers=1, threads_per_worker=2, dashboard_address=None)
    with away() if elsewhere else nullcontext(crew) as workers:
        results = conduct(study, out, workers=workers)
    assert max(results["status"].encoding["chunks"]) <= 16 < results["status"].size
    assert same(results, alone(study))
    assert same(results, conduct(study, out, workers="tcp://nobody:1"))  # nothing left to run
    with pytest.raises(StudyError, match=r"another study .* \(--out\).* overwrite=True"):
        conduct(Study(grid={"s": [0.0]}), out)


def test_the_command_reads_a_list_and_exports_tables(crew: LocalCluster, fmu_path, tmp_path: Path, capsys) -> None:
    starts = tmp_path / "starts.csv"
    starts.write_text("theta_start,phi_dot_start\n75deg,-2\n1.2,0\n")
    where = "--list", starts, "--fmu", fmu_path, "--out", tmp_path / "list.zarr", "--scheduler", crew.scheduler_address
    assert main([*map(str, where), "--csv", "--netcdf"]) == 0
    printed = capsys.readouterr().out
    assert re.match(r"2 wheels; this call took [\d.]+ s:\n", printed)
    assert "1 flat\n" in printed
    names, *rows = (tmp_path / "list.csv").read_text().splitlines()
    assert names.startswith("wheel,") and len(rows) == 2
    assert xr.open_dataset(tmp_path / "list.nc")["theta_start"].values[0] == np.radians(75)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("--list starts.csv --out starts.zarr --csv", "is read"),
        ("--list starts.csv --out ./link.zarr --csv", "is read"),
        ("--list inner.zarr/starts.csv --out inner.zarr --overwrite", "is read"),
        ("--vary s=0,0.1 --out thesis.zarr --csv", "thesis.csv is there and is not of this command"),
        ("--vary s=0,0.1 --out thesis.zarr --netcdf", "thesis.nc is there and is not of this command"),
        ("fates --out thesis.zarr", "thesis.png is there and is not of this command"),
    ],
)
def test_what_is_read_or_is_somebody_elses_is_not_overwritten(
    words: str, said: str, tmp_path: Path, fmu_path: Path, capsys, monkeypatch
) -> None:
    text = "theta_start\n1.2\n"
    (tmp_path / "inner.zarr").mkdir()
    for name in ("starts.csv", "inner.zarr/starts.csv", "thesis.csv", "thesis.nc", "thesis.png"):
        (tmp_path / name).write_text(text)
    (tmp_path / "link.csv").symlink_to("starts.csv")
    before = {path: path.read_bytes() for path in tmp_path.rglob("*.*") if path.is_file()}
    monkeypatch.chdir(tmp_path)
    assert main([*words.split(), "--fmu", str(fmu_path)]) == 2
    errors = capsys.readouterr().err
    assert said in errors and errors.count("\n") == 1
    assert {path: path.read_bytes() for path in tmp_path.rglob("*.*") if path.is_file()} == before


def test_its_own_tables_are_written_again_and_on_request_those_of_others(
    crew: LocalCluster, fmu_path: Path, tmp_path: Path, capsys
) -> None:
    (tmp_path / "a.csv").write_text("years of work")
    where = ["--fmu", str(fmu_path), "--out", str(tmp_path / "a.zarr"), "--scheduler", crew.scheduler_address, "--csv"]
    line = ["--vary", "s=0,0.1", "--stop-time", "0.1", *where]
    assert main(line) == 2 and main([*line, "--overwrite"]) == 0
    written = (tmp_path / "a.csv").read_text()
    assert main(line) == 0 and (tmp_path / "a.csv").read_text() == written
    assert "%|" not in capsys.readouterr().err  # a progress bar, which is for terminals


def test_a_check_states_the_error_of_some_wheels_and_keeps_it_in_two_columns(
    crew: LocalCluster, fmu_path: Path, tmp_path: Path, capsys
) -> None:
    """Partner: at a loose tolerance the error is another; two wheels of three are drawn."""
    where = ["--fmu", str(fmu_path), "--scheduler", crew.scheduler_address, "--stop-time", "2", "--check", "2"]
    found = []
    for name, tolerance in (("a", "1e-8"), ("b", "1e-5")):
        out = tmp_path / f"{name}.zarr"
        assert main(["--vary", "s=0,0.01,0.03", "--tolerance", tolerance, "--out", str(out), "--csv", *where]) == 0
        said = capsys.readouterr().out
        stated = float(re.search(r"Of 2 wheels run again with another solver .* is at most (\S+) of", said)[1])
        error = xr.open_zarr(out, consolidated=False)["check_error"].values
        assert np.isfinite(error).sum() == 2
        within(abs(stated / np.nanmax(error) - 1), 0.1, "error stated beside that in the table, relative")
        assert "check_error,check_shift" in (tmp_path / f"{name}.csv").read_text()
        found.append(np.nanmax(error))
    within(found[0], 1e-7, "error / range")
    beyond(found[1] / found[0], 10, "error at a loose tolerance over it")
    with pytest.raises(SystemExit, match="2"):
        main(["--vary", "s=0,0.01", *where[:2], "--check", "0"])


def test_a_check_runs_with_own_workers_in_a_process_of_its_own(fmu_path: Path, tmp_path: Path) -> None:
    """There Dask's scheduler reloads the package from a file that is deleted before the check."""
    words = ["--vary", "s=0,0.01", "--stop-time", "0.1", "--check", "2", "--workers", "1"]
    command = [sys.executable, "-m", "lab.studies", *words, "--fmu", str(fmu_path), "--out", str(tmp_path / "z")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "Of 2 wheels run again" in done.stdout and "the end of a run is not shifted." in done.stdout


VARY = {"theta_start=60deg:90deg:3": np.radians([60, 75, 90]), "slope=0%:10%:3": np.arctan([0, 0.05, 0.1])}
VARY |= {"s=0,1cm": [0, 0.01], "phi_dot_start=-30rpm:-3:2": [-np.pi, -3]}


@pytest.mark.parametrize(("axis", "expected"), VARY.items())
def test_values_on_the_command_line_take_the_units_of_their_variables(axis: str, expected: list[float]) -> None:
    ((_, got),) = arguments_of(["--vary", axis]).study.grid.items()
    within(absolute_error(got, expected), 8 * EPSILON, f"{axis}, SI")


def test_wheels_that_cannot_exist_are_run_with_a_warning_that_counts_them(conduct, capsys) -> None:
    study = Study(grid={"m": [10.0, 15.0, 20.0], "s": [0.0, 0.01]}, stop_time=0.1)
    assert (conduct(study)["status"] == Status.reached).all()
    said = capsys.readouterr().err
    assert "study: warning: 2 of 6 wheels cannot exist. The first: J_z = 1.8 kg m2 is more than m (r_0 + r)^2" in said
    conduct(replace(study, grid={"m": [18.0, 20.0], "s": [0.0, 0.01]}))
    assert "warning" not in capsys.readouterr().err


@pytest.mark.parametrize("name", ["fates", "grip", "uptime"])
def test_an_example_draws_what_it_runs_and_every_wheel_of_its_map_reaches_the_end(name: str, conduct, tmp_path) -> None:
    content = study_file(file_of(name))
    grid = {n: axis[:: max(1, len(axis) // 8)] for n, axis in content["study"].grid.items()}
    results = conduct(replace(content["study"], grid=grid))
    assert (results["status"] == Status.reached).all()
    assert save_png(content["draw"](results), tmp_path / "few.png").stat().st_size > 10_000


def test_where_the_least_normal_force_of_a_kept_contact_is_negative_the_wheel_lifts_off(alone) -> None:
    """So its zero is the smooth boundary of the map of fates."""
    grid = {"theta_start": np.radians([5, 10, 20, 30, 45, 60]), "phi_dot_start": [-15.0, -22.0, -30.0, -45.0]}
    free = alone(Study(grid=grid, values={"s": 0.03}))
    least = alone(Study(grid=grid, values={"s": 0.03, "keep_contact": 1.0}, measures={"N": "min(lambda_3)"}))
    lifts = free["status"].values == Status.lifted_off
    assert ((least["N"].values < 0) == lifts).all() and 0 < lifts.sum() < lifts.size


LEANS, SPINS = np.linspace(1, 1.5, 7), np.linspace(-6, 0, 7)
PICTURES = {  # what varies; labels of the sides; lines; the dots of the wheels that lie flat, at zero spin
    "a curve": ({"phi_dot_start": SPINS}, ("phi_dot_start [rad/s]", "low [deg]"), 1, 1),
    "curves": ({"theta_start": LEANS, "s": [0.0, 0.01]}, ("theta_start [deg]", "low [deg]"), 2, 0),
    "a map": ({"theta_start": LEANS, "phi_dot_start": SPINS}, ("theta_start [deg]", "phi_dot_start [rad/s]"), 0, 7),
    "a part": ({"m": [18.0, 20.0], "s": [0.0, 0.01], "r": [0.04, 0.05, 0.06]}, ("r [m]", "low [deg]"), 2, 0),
}


@pytest.mark.parametrize(("grid", "sides", "lines", "flat"), PICTURES.values(), ids=PICTURES)
def test_a_study_of_options_is_drawn_as_a_curve_curves_or_a_map_and_a_fate_has_a_dot_and_no_area(
    grid, sides, lines, flat, conduct
) -> None:
    """A column of wheels without spin has no width."""
    figure = pictures.draw(conduct(Study(grid=grid, measures={"low": "lowest"}, stop_time=1.0)))
    ax, legends = figure.axes[0], [text.get_text() for one in figure.legends for text in one.get_texts()]
    dots = [line for line in ax.lines if line.get_linestyle() == "None"]
    assert (ax.get_xlabel(), ax.get_ylabel()) == sides
    assert len(ax.lines) - len(dots) == lines and sum(len(line.get_xdata()) for line in dots) == flat
    assert legends == ["lies flat"] * bool(flat)
    ink = pictures.style.mpl.colors.to_rgba(pictures.style.INK)
    assert not any((colour == ink).all() for one in ax.collections for colour in one.get_facecolor())


def test_a_list_is_drawn_wheel_by_wheel_and_nothing_where_nothing_varies(conduct) -> None:
    starts = {"theta_start": [1.2, 1.3, 1.4], "phi_dot_start": [-2.0, 0.0, -3.0]}
    ax = pictures.draw(conduct(Study(list=starts, stop_time=1.0))).axes[0]
    assert ax.get_xlabel() == "theta_start [deg]" and len(ax.collections[0].get_offsets()) == 3
    assert pictures.draw(conduct(Study(grid={"s": [0.0]}, stop_time=1.0))) is None


def test_earlier_results_go_on_by_the_name_of_their_folder(
    conduct, tmp_path, capsys, fmu_path, crew, monkeypatch
) -> None:
    """Grids and a list; then none is run again. A name that is neither is refused as before."""
    studies = [FATES, LISTED, Study(grid={"r": [0.05, 0.06], "m": [18.0, 20.0]}, stop_time=0.1)]
    for k, study in enumerate(studies):
        place = tmp_path / "results" / "studies" / f"earlier_{k}.zarr"
        results = conduct(study, place)
        assert study_of(results) == study
    monkeypatch.setattr(options, "ROOT", tmp_path)
    for name in ("earlier_2", str(place)):
        assert main([name, "--fmu", str(fmu_path), "--scheduler", crew.scheduler_address]) == 0
        printed = capsys.readouterr()
        assert "4 of 4 wheels are there already." in printed.err
        assert printed.out.splitlines()[-1] == f"Wrote {place.with_suffix('.png')}"
    assert main(["nowhere"]) == 2 and "There is no study nowhere" in capsys.readouterr().err
