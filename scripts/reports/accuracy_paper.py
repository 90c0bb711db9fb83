"""The paper's two scenes: errors against the tables, convergence, energy, the 37 transitions, the long run."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from physics.measure import FRICTION, energy_error, instants, instants_error, table_errors
from reference.tables import read_table
from support.driver import HEADLINE
from support.motion import Library

from . import accuracy_figures as figures
from .markdown import image, number, table
from .part import Check, Part

TOLERANCES = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13)


def headline(product: Library) -> Part:
    errors = {scene: table_errors(product, scene) for scene in FRICTION}
    rows = [(f"`{name}`", *(errors[scene][name] for scene in FRICTION)) for name in HEADLINE]
    checks = [
        Check(f"{scene} scene: error of any headline output / its range", "at most", 1e-6, max(errors[scene].values()))
        for scene in FRICTION
    ]
    worst = max(check.measured for check in checks)
    near = [max(table_errors(product, "free", 1e-8 * x).values()) for x in np.linspace(0.9, 1.1, 21)]
    text = f"""## The paper's scenes at the default tolerance

Largest error over the 101 rows of the tables, as a part of the output's range: at most {number(worst)}.
The steps that a solver happens to choose scatter such a figure: over 21 tolerances from 0.9e-8 to 1.1e-8 the free
wheel's lies between {number(min(near))} and {number(max(near))}, median {number(float(np.median(near)))}.

{table(["output", "free (s = 0)", "friction (s = 0.03 m)"], rows)}"""
    return Part(text, checks)


def convergence(product: Library, folder: Path) -> Part:
    rows = []
    for tolerance in TOLERANCES:
        worst = [max(table_errors(product, scene, tolerance).values()) for scene in FRICTION]
        found = instants(product, tolerance)
        rows.append((tolerance, *worst, energy_error(product, tolerance), instants_error(found), len(found)))
    figures.convergence(np.array(rows), folder / "accuracy_convergence.png")
    middle = [row for row in rows if 1e-10 <= row[0] <= 1e-5]
    orders = [np.log10(middle[0][i] / middle[-1][i]) / (len(middle) - 1) for i in (1, 2, 3)]
    tight = rows[TOLERANCES.index(1e-12)]
    header = ["tolerance", "free", "friction", "energy, free", "instants, s", "transitions"]
    text = f"""## Convergence with the tolerance

Headline errors (free, friction) as parts of the range; relative error of the free wheel's energy; error of the
instants of the 37 transitions. From 1e-5 to 1e-10 a decade of tolerance takes {orders[0]:.2f} decades off the free
wheel's error, {orders[1]:.2f} off the friction scene's and {orders[2]:.2f} off the energy's. The tables carry 11 digits
and instants to 1e-9 s: errors below some 1e-10, and of instants below 1e-9 s, are not the FMU's.

{table(header, rows)}

{image("accuracy_convergence.png", "errors over tolerance")}"""
    checks = [
        Check("free scene: relative energy error over 10 s", "at most", 1e-8, energy_error(product)),
        Check("the same at tolerance 1e-12", "at most", 1e-12, tight[3]),
        Check("tolerances at which not all 37 transitions are found", "exactly", 0, sum(r[5] != 37 for r in rows)),
    ]
    return Part(text, checks)


def transitions(product: Library) -> Part:
    want, found = read_table("paper_friction_events"), instants(product)
    kind = {0: "held", 1: "omega_z > 0", -1: "omega_z < 0"}
    pairs = list(zip(want["t"][1:], found, strict=False))
    lines = [(i + 1, kind[got[1]], f"{got[0]:.9g}", float(got[0] - t)) for i, (t, got) in enumerate(pairs)]
    error = instants_error(found)
    text = f"""## The transitions of rolling friction

{len(found)} transitions in 10 s at the default tolerance (37 in the table); the largest error of an instant is
{number(error)} s.

<details><summary>All {len(found)}</summary>

{table(["", "becomes", "t, s", "error, s"], lines)}

</details>"""
    return Part(text, [Check("friction scene: error of the instants of all 37 transitions, s", "at most", 1e-6, error)])


def dissipation(product: Library, folder: Path) -> Part:
    times = np.linspace(0, 10, 2001)
    free, rough = (product.simulate(times, s=s) for s in FRICTION.values())
    figures.energy(times, free, rough, folder / "accuracy_energy.png")
    long = product.simulate([0.0, 10.0, 30.0, 80.0, 90.0, 150.0], s=0.03)
    tight = product.simulate([0.0, 150.0], 1e-12, s=0.03)
    held = float((rough["friction_mode"] == 0).mean())
    rows = [
        (int(t), f"{energy:.5f}", sum(x <= t for x, _ in long.events))
        for t, energy in zip(long.t, long["E"], strict=True)
    ]
    text = f"""## What friction takes

Without friction the energy stays at {free["E"][0]:.6f} J; with s = 0.03 m it falls to {rough["E"][-1]:.6f} J in 10 s,
only while the wheel rolls: for {100 * held:.1f} % of the time it is held at omega_z = 0 and loses nothing. The slips
go on, ever weaker; at tolerance 1e-12 there are {len(tight.events)} transitions in 150 s and
E(150 s) = {tight["E"][-1]:.5f} J, at the default tolerance:

{table(["t, s", "E, J", "transitions"], rows)}

{image("accuracy_energy.png", "energy over time without and with friction")}"""
    return Part(text)


def parts(product: Library, folder: Path) -> list[Part]:
    return [
        headline(product),
        convergence(product, folder),
        transitions(product),
        dissipation(product, folder),
    ]
