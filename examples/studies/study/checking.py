"""Whether the results of a study can be trusted: some of its wheels again at the FMU's tightest tolerance."""

import math
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import xarray as xr
from fmpy import extract

from .dataset import axes_of, points
from .plan import Study
from .worker import Array, Instance, Result, pack, run_block

HEADLINE = ("X_O", "theta", "phi_dot", "psi_dot")
TIGHTEST, PARTED = 1e-13, 1e-3  # tolerance; of the range, a difference at which three digits are lost
ERROR = "Largest difference of a headline output from the run at the tightest tolerance, over its range"
SHIFT = "By how much the run ends later than at the tightest tolerance"


def errors(loose: Result, tight: Result) -> Array:
    """By wheel; rows that one of both runs lacks are left out. An output without range counts as it is, in SI."""
    parts = []
    for name in HEADLINE:
        span = np.ptp(np.nan_to_num(tight[name] - tight[name][:, :1]), axis=1)
        apart = np.nan_to_num(np.abs(loose[name] - tight[name])).max(axis=1)
        parts.append(apart / np.where(span > 1e-9, span, 1.0))
    return np.where(np.isfinite(tight["theta"][:, 0]), np.max(parts, axis=0), np.nan)


def checked(study: Study, results: xr.Dataset, fmu: Path, place: str, count: int) -> tuple[xr.Dataset, str]:
    """The results with two more columns, of `count` wheels drawn at random, and a sentence for the summary."""
    axes = axes_of(study)
    shape, every = tuple(axes.sizes.values()), points(axes, (slice(None),) * len(axes.sizes))
    drawn = np.sort(np.random.default_rng(0).permutation(math.prod(shape))[:count])
    few = {name: np.broadcast_to(values, shape).ravel()[drawn] for name, values in every.items()}
    common = replace(study, grid={}, list={}, measures={}, history=HEADLINE)
    with TemporaryDirectory() as folder:
        instance = Instance(extract(str(pack(fmu, Path(folder) / "wheel.zip")), folder))
        loose, tight = (run_block(instance, replace(common, tolerance=t), few) for t in (study.tolerance, TIGHTEST))
    error, shift = errors(loose, tight), loose["end_time"] - tight["end_time"]
    columns = {}
    for name, unit, meaning, values in (("check_error", "1", ERROR, error), ("check_shift", "s", SHIFT, shift)):
        column = np.full(math.prod(shape), np.nan)
        column[drawn] = values
        columns[name] = ([*axes.sizes], column.reshape(shape), {"units": unit, "description": meaning})
    xr.Dataset(columns, attrs=results.attrs).to_zarr(place, mode="a", consolidated=False, zarr_format=3)
    ran = np.isfinite(error)
    if not ran.any():
        return results.assign(columns), f"None of the {len(drawn)} wheels to be checked runs."
    worst, usual, late = error[ran].max(), np.median(error[ran]), np.abs(shift[ran]).max()
    said = f"Of {ran.sum()} wheels run again at the tightest tolerance the error is at most {worst:.1e} of the range"
    said += f" (median {usual:.1e}); the end of a run shifts by up to {late:.1e} s."
    parted = int((error[ran] > PARTED).sum())
    return results.assign(columns), said + f" In {parted} of them both runs part: unstable or chaotic." * bool(parted)
