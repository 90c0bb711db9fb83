"""What came out of a study, in a few lines: how many wheels met which fate, wheels per second, and the FMU's share."""

from __future__ import annotations

import numpy as np
import xarray as xr

from .instance import Status


def summarize(results: xr.Dataset, seconds: float) -> str:
    """Counts per status, the first message of those that were not run, and speed.

    The speed is of the runs themselves, summed over the workers; `seconds` is the time of this call, workers' start and
    writing included, which may have run only a part of the study.
    """
    status = results["status"].values
    lines = [f"{status.size} wheels in {seconds:.1f} s:"]
    for code in Status:
        found = status == code
        if not found.any():
            continue
        lines.append(f"  {found.sum():8d} {code.name.replace('_', ' ')}")
        if code in (Status.refused, Status.failed):
            lines.append(f"           first: {results['message'].values[found][0]}")
    wall, inside = (float(np.nansum(results[name])) for name in ("wall_time", "fmu_time"))
    if wall > 0:
        speed = np.isfinite(results["wall_time"].values).sum() / wall
        lines.append(
            f"{speed:.0f} wheels per second and worker, {100 * inside / wall:.0f} % of the time inside the FMU."
        )
    return "\n".join(lines)
