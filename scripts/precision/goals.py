"""The speed to reach, goal by goal, judged by what this run measured."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .compare import ratio
from .runner import Sheet
from .scenes import TARGETS

OURS = "FMU automatic"
YARDSTICKS = ("heyoka", "DOP853 C++")


@dataclass(frozen=True)
class Goal:
    """measured <= bound; measured None: could not be measured here."""

    what: str
    bound: float
    measured: float | None
    unit: str = ""

    @property
    def verdict(self) -> str:
        if self.measured is None:
            return "not measured"
        return "reached" if self.measured <= self.bound else "**not reached**"


def ratio_goals(sheets: list[Sheet]) -> list[Goal]:
    goals = []
    for sheet in sheets:
        if sheet.scene.name not in ("free", "friction"):
            continue
        for error in TARGETS:
            for peer in YARDSTICKS:
                what = f"{sheet.scene.name} wheel at error {error:.0e}: time over that of {peer}"
                goals.append(Goal(what, 2.0, ratio(sheet, OURS, peer, error)))
    return goals


def crowd_goals(crowd: dict[str, Any]) -> list[Goal]:
    threads = crowd["threads"]
    different = sum(threads[k]["different"] for k in ("1", "2"))
    one = threads["1"]
    return [
        Goal("an instance: memory", 16, one["bytes_stepped"] / 1024, "KiB"),
        Goal("an instance: create, initialise and free, alone", 10, 1e6 * crowd["alone"], "µs"),
        Goal(f"the same, {crowd['instances']} at once", 10, 1e6 * (one["start"] + one["free"]), "µs"),
        Goal(
            f"instances of {crowd['instances']} with other bits than alone, in turn and from two threads", 0, different
        ),
    ]


def goals(sheets: list[Sheet], extra: dict[str, Any]) -> list[Goal]:
    found = ratio_goals(sheets)
    found.append(Goal("share of the friction scene's time for its restarts", 0.5, extra["events"]["share"]))
    for row in extra["cosimulation"]:
        if row["step"] == 1e-3 and row["scene"] in ("free", "friction"):
            what = f"{row['scene']} wheel: doStep of 1 ms with four outputs read"
            found.append(Goal(what, 100, row["read"], "ns"))
    found += crowd_goals(extra["crowd"])
    for scene in ("free", "friction"):
        costs = [row["cost"] for row in extra["long_runs"] if row["scene"] == scene]
        what = f"{scene} wheel: cost per simulated second, largest over that of the first 10 s"
        found.append(Goal(what, 1.1, max(costs) / costs[0]))
    python = extra["python"]
    found.append(Goal("share of `fmpy simulate` inside the FMU", 0.02, python["fmu"] / python["wall"]))
    found.append(Goal("FMU archive", 1.0, extra["archive"]["fmu"] / 2**20, "MiB"))
    found.append(Goal("loading the library", 10, 1e3 * python["load"], "ms"))
    return found
