"""Whether the results of a study can be trusted: some of its wheels again by another solver, at the tightest tolerance.

CVODE's Adams, or DOP853 for wheels that run by CVODE: wheelfmu.truth.trust."""

import math
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import xarray as xr
from fmpy import extract

from wheelfmu.fmu.driver import HEADLINE
from wheelfmu.truth.errors import by_instant
from wheelfmu.truth.trust import ADAMS, BDF, DIGITS, RUNGE_KUTTA, TIGHTEST

from .dataset import axes_of, points
from .plan import Study
from .worker import Instance, pack, run_block

ERROR = "Largest difference of a headline output from the run by another solver, over its range"
SHIFT = "By how much the run ends later than by another solver"


def checked(study: Study, results: xr.Dataset, fmu: Path, place: str, count: int) -> tuple[xr.Dataset, str]:
    """The results with two more columns, of `count` wheels drawn at random, and a sentence for the summary."""
    axes = axes_of(study)
    shape, every = tuple(axes.sizes.values()), points(axes)
    drawn = np.sort(np.random.default_rng(0).permutation(math.prod(shape))[:count])
    few = {name: np.broadcast_to(values, shape).ravel()[drawn] for name, values in every.items()}
    common = replace(study, grid={}, list={}, measures={}, history=HEADLINE)
    with TemporaryDirectory() as folder:
        instance = Instance(extract(str(pack(fmu, Path(folder) / "wheel.zip")), folder))
        methods = few.get("method", np.full(len(drawn), common.values.get("method", 1)))
        other = np.where(np.isin(methods, [int(ADAMS), int(BDF)]), int(RUNGE_KUTTA), int(ADAMS))
        runs = [run_block(instance, common, few)]
        runs += [run_block(instance, replace(common, tolerance=TIGHTEST), few | {"method": other})]
    error, shift = np.full((2, math.prod(shape)), np.nan)
    for k, wheel in enumerate(drawn):
        rows, truth = (np.column_stack([run[name][k] for name in HEADLINE]) for run in runs)
        there = np.isfinite(rows[:, 0] + truth[:, 0])  # until the earlier end of both
        if there.any():
            error[wheel] = by_instant(rows[there], truth[there]).max()
            shift[wheel] = runs[0]["end_time"][k] - runs[1]["end_time"][k]
    about = {
        "check_error": ([*axes.sizes], error.reshape(shape), {"units": "1", "description": ERROR}),
        "check_shift": ([*axes.sizes], shift.reshape(shape), {"units": "s", "description": SHIFT}),
    }
    xr.Dataset(about, attrs=results.attrs).to_zarr(place, mode="a", consolidated=False, zarr_format=3)
    found, late = error[np.isfinite(error)], np.abs(shift[np.isfinite(shift)])
    if not found.size:
        return results.assign(about), f"None of the {len(drawn)} wheels to be checked runs."
    said = f"Of {found.size} wheels run again with another solver the error is at most {found.max():.1e} of the"
    shifted = f"shifts by up to {late.max():.1e} s" if late.any() else "is not shifted"
    said += f" range (median {np.median(found):.1e}), and the end of a run {shifted}."
    parted, shared = int((found > DIGITS).sum()), int((runs[1]["n_jac"] > 0).sum())
    said += f" In {parted} of them the motion is unstable or chaotic, and the two runs part." * bool(parted)
    said += f" In {shared} of them slides or boundary layers are solved by the same solver." * bool(shared)
    return results.assign(about), said
