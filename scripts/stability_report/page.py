"""The text of docs/results/stability.md. Every number in it comes from the results."""

from __future__ import annotations

from robustness.drift import Drift
from robustness.regularized import TOLERANCE_FACTOR, WIDTH_FACTOR, Crossing, Point

from .report import (
    Results,
    amplification,
    contract_tables,
    footer,
    long_table,
    order_sentence,
    regularized_table,
    remarks,
    sweep_table,
    table,
)

INTRODUCTION = """# Numerical stability: stiff and extreme cases

Written by `./scripts/stability`; every number and verdict on this page is computed by that run. Each case runs in a
process of its own with a deadline, driven through fmpy. The tolerance is the one given to fmi2SetupExperiment.

An error is judged by energy (with the friction's work integrated from the outputs), by Chaplygin's linear integrals, by
the independent reference of `tests/reference`, or by a closed form; errors are relative. In the table of cases **bold**
marks a broken expectation, (brackets) a tolerance too loose for what the case asks.
"""


def summary(results: Results) -> str:
    faults = results.faults()
    count = sum(len(v) for v in results.verdicts().values())
    checks = sum(len(c) for c in results.contract.values() if not isinstance(c, str))
    head = f"{len(results.sweep)} cases, {count} runs and {checks} checks of the contract: "
    if not faults:
        return head + "all as expected; no hang, no crash, no number that is not finite."
    return head + f"**{len(faults)} not as expected:**\n\n" + "\n".join(f"- {fault}" for fault in faults)


def reliance(results: Results) -> str:
    loose = [name for name, (case, _) in results.sweep.items() if case.loosest < 1e-4]
    lines = [
        "## What a user may rely on",
        f"- Energy balance: {amplification(results, 'energy')}.",
        f"- Linear integrals: {amplification(results, 'integrals')}.",
        f"- Outputs against the independent reference, phase included: {amplification(results, 'reference')}.",
        f"- Instants of endings: {instants(results)}",
        f"- Cases that need a tolerance of 1e-6 or less: {'; '.join(loose) or 'none'}.",
        "- How one sees that results degrade: read `E`. Without friction and inputs it is constant; its relative",
        "  change is the size of the error of one nutation, and phase errors are larger by the number of nutations.",
        "- A ground that pulls (`keep_contact`, N < 0) has no rolling friction; contact holds both ways.",
        f"- The regularized law: {width_words(results.regularized)}",
        "- One doStep takes at most a million internal steps, more if it is long; then it ends in fmi2Error with that",
        "  reason.",
        "- A run that starts at an unstable equilibrium (upright at rest) stays there until rounding makes it fall;",
        "  the instant of that fall is not physics.",
    ]
    return "\n".join(lines)


def width_words(points: list[Point]) -> str:
    """Price of the regularized law at the accuracy of the exact one, and the width below which nothing is gained."""
    words = []
    for tolerance in sorted({p.tolerance for p in points}, reverse=True):
        exact = next(p for p in points if p.tolerance == tolerance and p.law == "exact")
        narrow = [p for p in points if p.tolerance == tolerance and p.law != "exact"]
        best = min(narrow, key=lambda p: p.error)
        words.append(
            f"at tolerance {tolerance:g} its best error is {best.error:.0e} (omega_s = {best.omega_s:g} rad/s, "
            f"{best.milliseconds:.1f} ms), the exact law's {exact.error:.0e} ({exact.milliseconds:.1f} ms)"
        )
    return "; ".join(words) + "."


def instants(results: Results) -> str:
    errors = [
        (f.error, f"{name} at {v.tolerance:g}")
        for name, verdicts in results.verdicts().items()
        for v in verdicts
        for f in v.errors
        if f.judge == "instant" and v.claimed and v.tolerance <= 1.1e-8
    ]
    below = sum(e <= 1e-6 for e, _ in errors)
    worst = max(errors)
    runs = f"{below} of {len(errors)} runs at tolerances of 1e-8 and less within 1e-6 s"
    return f"{runs}; largest error {worst[0]:.1e} s ({worst[1]})."


def sweep_part(results: Results) -> str:
    return f"""## The sweep

![Errors over tolerance](stability_sweep.png)

{sweep_table(results)}

Remarks:

{remarks(results)}"""


def crossing_words(found: list[Crossing], threshold: float) -> str:
    wrong = [c for c in found if (c.chosen == "bdf") != (c.ratio > 1)]
    lost = [max(c.ratio, 1 / c.ratio) for c in wrong]
    where = f"at worst {max(lost):.2f} x the time of the better one" if lost else "never"
    pays = [c.decay for c in found if c.ratio > 1]
    return (
        f"BDF is the faster one in {len(pays)} of the {len(found)} points, the smallest of them at a decay number of "
        f"{min(pays):.0f}. `method = automatic` takes the slower one in {len(wrong)} points, {where}. "
        f"The decay number is s m g / (omega_s (J_z + m rho^2)) times sqrt(rho / g), rho = r_0 + r; "
        f"the dotted line is {threshold:g}."
    )


def regularized_part(results: Results, threshold: float) -> str:
    return f"""## The regularized law

Paper's friction scene, 10 s; error of the headline outputs against the exact law, over the range of each; time of one
large doStep. Adams is left out where its cost, proportional to 1/omega_s, would be seconds.

![Convergence and cost](stability_regularized.png)

{regularized_table(results.regularized)}

Bound: {WIDTH_FACTOR:g} omega_s + {TOLERANCE_FACTOR:g} x tolerance. {order_sentence(results.regularized)}

![Where BDF pays](stability_methods.png)

{crossing_words(results.crossings, threshold)}"""


def long_part(results: Results) -> str:
    rows = [(f"{t:g}", f"{n:.0f}", f"{e:.6f}") for t, n, e in results.resolved]
    best = results.resolved[-1]
    spread = max(abs(e - best[2]) / best[2] / t for t, _, e in results.resolved[:-1])
    return f"""## Long runs

Tolerance 1e-8. Energy is read ten times in each sixtieth of a run; its largest rise between two readings is the
integration error of that stretch, not rounding: while the spin is held the wheel is conservative, and energy is kept
to the tolerance only. In 24 h the drift adds up.

![Long runs](stability_long.png)

{long_table(results.long_runs)}

The slips of the friction scene never end. At the end of an hour, for each tolerance:

{table(("tolerance", "transitions", "E at 1 h [J]"), rows)}

A slip weaker than the tolerance resolves may be missed or added; what that does to the energy in an hour is at most
{spread:.0f} times the tolerance (relative, against 1e-12)."""


def drift_part(drifts: list[Drift]) -> str:
    rows = []
    for d in drifts:
        half = len(d.t) // 2
        ends = (d.velocity[1:half].max(), d.velocity[half:].max())
        rows.append(
            (d.name, f"{ends[0]:.0e}", f"{ends[1]:.0e}", f"{d.height.max():.0e}", "yes" if d.worst <= 1e-9 else "no")
        )
    heads = ("multibody, tolerance 1e-8", "velocity, first half", "velocity, second half", "height", "within 1e-9")
    return f"""## Constraint drift of the multibody formulation

Residual of (19) over the largest speed, and of (32) over r_0 + r. The reduced formulation has none by construction.

![Drift](stability_drift.png)

{table(heads, rows)}

Largest residual: {max(d.worst for d in drifts):.1e}."""


def contract_part(results: Results) -> str:
    return f"## The contract at its edges\n\n{contract_tables(results)}"


def page(results: Results, threshold: float) -> str:
    parts = [
        INTRODUCTION,
        summary(results),
        reliance(results),
        sweep_part(results),
        regularized_part(results, threshold),
    ]
    parts += [long_part(results), drift_part(results.drifts), contract_part(results), footer(results)]
    return "\n\n".join(part.strip("\n") for part in parts) + "\n"
