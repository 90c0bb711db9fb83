"""The whole report: measures, draws, writes. Called by scripts/work_precision."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from . import costs, left_out
from .builds import ROOT, Build, build
from .measure import Worker
from .report import summary, write
from .runner import Plan, Progress, run_scene
from .scenes import SCENES
from .sheets import draw


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="scripts/work_precision", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="two scenes, fewer tolerances, one round: under a minute")
    parser.add_argument("--scenes", help="comma-separated names; no report is written", default="")
    parser.add_argument("--rounds", type=int, help="rounds in which the set-ups take turns (5; quick: 1)")
    parser.add_argument("--build", type=Path, default=ROOT / "build" / "release", help="CMake's build folder")
    parser.add_argument("--output", type=Path, help="where to write (docs/results; quick: build/work_precision)")
    return parser.parse_args()


def measure_costs(built: Build, worker: Worker, quick: bool, say: Progress) -> dict[str, Any]:
    extra: dict[str, Any] = {}
    for part in (costs.cosimulation, costs.crowd, costs.long_runs, costs.instructions, costs.python):
        say.say(f"costs: {part.__name__}")
        extra[part.__name__] = part(built, quick)
    say.say("costs: what is left out")
    extra["left_out"], extra["events"] = left_out.price(built), left_out.price_of_events(built)
    extra["archive"], extra["machine"] = costs.archive(built), costs.machine(built)
    extra["versions"] = worker.ask({"versions": True})
    say.say("costs: done", line=True)
    return extra


def main() -> None:
    options = arguments()
    say = Progress()
    rounds = options.rounds or (1 if options.quick else 5)
    plan = Plan(rounds, 0.02 if options.quick else 0.04, options.quick)
    say.say("building the driver and the peers")
    built = build(options.build.resolve())
    worker = Worker(built)
    wanted = options.scenes.split(",") if options.scenes else [s.name for s in SCENES[: 2 if options.quick else None]]
    try:
        sheets = [run_scene(built, worker, s, plan, say) for s in SCENES if s.name in wanted]
        if not options.scenes:
            extra = measure_costs(built, worker, options.quick, say)
            folder = options.output or (built.work if options.quick else ROOT / "docs" / "results")
            write(sheets, extra, rounds, folder / "work_precision.md")
            for sheet in sheets:
                draw(sheet, folder / f"work_precision_{sheet.scene.name}.png")
            say.say(f"wrote {folder / 'work_precision.md'}", line=True)
    finally:
        worker.close()
    print(summary(sheets))


if __name__ == "__main__":
    main()
