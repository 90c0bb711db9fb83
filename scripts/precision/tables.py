"""The report's tables of costs beside the solution: co-simulation, instances, long runs, instructions, Python, what was
left out, and the footer."""

from __future__ import annotations

from typing import Any

from .cells import microseconds, number, table

Extra = dict[str, Any]


def cosimulation(extra: Extra) -> str:
    rows = [
        (r["scene"], f"{1e3 * r['step']:g} ms", *(number(r[k], ".0f") for k in ("read", "read_median", "unread")))
        for r in extra["cosimulation"]
    ]
    head = ("scene", "communication step", "four outputs read, best", "median (processor time)", "nothing read, best")
    return "## Co-simulation\n\nns per doStep at the default tolerance, solution included.\n\n" + table(head, rows)


def crowd(extra: Extra) -> str:
    c = extra["crowd"]
    rows = []
    for threads in ("1", "2"):
        t = c["threads"][threads]
        times = (f"{1e6 * t[k]:.1f}" for k in ("start", "free"))
        rows.append((threads, *times, microseconds(t["solve"]), f"{t['bytes_stepped']:.0f}", str(t["different"])))
    head = ("threads", "create and initialise µs", "free µs", "1.5 s of motion µs", "bytes", "other bits than alone")
    text = (
        f"## {c['instances']:,} friction wheels in one process\n\nPer instance; stepped in turn, 0.1 s each; memory by"
    )
    text += f" mallinfo2. Alone: create, initialise and free in {1e6 * c['alone']:.1f} µs (median).\n\n"
    return text + table(head, rows)


def long_runs(extra: Extra) -> str:
    rows = [
        (
            r["scene"],
            f"{r['stop']:,}",
            number(r["cost"], ".1f"),
            *(number(r[k], ".1f") for k in ("n_steps", "n_rhs", "n_events")),
        )
        for r in extra["long_runs"]
    ]
    head = ("scene", "length s", "processor time µs", "steps", "right-hand sides", "events")
    return "## Cost per simulated second\n\n" + table(head, rows)


def instructions(extra: Extra) -> str:
    rows = [(r["scene"], f"{1e3 * r['step']:g} ms", f"{r['instructions']:,}") for r in extra["instructions"]]
    text = "## Instructions of the first simulated second\n\nBy callgrind, four outputs read each communication step,"
    text += " default tolerance. They do not depend on the load of the machine.\n\n"
    return text + (table(("scene", "communication step", "instructions"), rows) if rows else "valgrind is missing.\n")


def python(extra: Extra) -> str:
    p, a = extra["python"], extra["archive"]
    share = f"{100 * p['fmu'] / p['wall']:.2f} %"
    rows = [
        ("`fmpy simulate wheel.fmu`, 10 s every 0.01 s, the whole command", f"{1e3 * p['wall']:.0f} ms"),
        ("`fmpy.simulate_fmu` of the unpacked FMU", f"{1e3 * p['call']:.1f} ms"),
        ("the same calls from C: start, 1000 steps, all outputs", f"{1e3 * p['fmu']:.2f} ms"),
        ("share of the command inside the FMU", share),
        ("share of `simulate_fmu` inside the FMU", f"{100 * p['fmu'] / p['call']:.1f} %"),
        ("reading the description, unpacking the archive", f"{1e3 * p['read']:.1f} ms, {1e3 * p['unpack']:.1f} ms"),
        ("loading the library (dlopen)", f"{1e3 * p['load']:.2f} ms"),
        ("archive, library in it", f"{a['fmu'] / 1024:.0f} KiB, {a['library'] / 1024:.0f} KiB"),
    ]
    return "## What Python costs, and the archive\n\n" + table(("what", ""), rows)


def left_out(extra: Extra) -> str:
    rows = []
    for r in extra["left_out"]:
        changes = [f"{k}: {a} → {b}" for k in ("n_rhs", "n_roots", "n_jac", "n_restarts") for a, b in [r[k]] if a != b]
        factor = f"{r['with'] / r['without']:.2f}"
        rows.append(
            (r["what"], r["forced_by"], microseconds(r["without"]), microseconds(r["with"]), factor, ", ".join(changes))
        )
    head = ("left out", "forced by", "without µs", "with µs", "factor", "counters")
    e = extra["events"]
    text = "## What is left out, and what that saves\n\nFree wheel, 10 s, default tolerance; "
    text += "tests/contract/test_left_out.py proves"
    text += " by counters that it is left out.\n\n" + table(head, rows)
    text += (
        f"\nA restart costs {1e6 * e['each']:.1f} µs and {e['rhs_each']:.0f} right-hand sides (free wheel with as many"
    )
    text += (
        f" jumps of a small force); the friction wheel's {e['restarts']} are {100 * e['share']:.0f} % of its time.\n"
    )
    return text


def footer(extra: Extra) -> str:
    rows = [*extra["machine"].items(), *extra["versions"].items()]
    return "## Where and with what\n\n" + table(("", ""), rows)


def cost_parts(extra: Extra) -> list[str]:
    return [part(extra) for part in (cosimulation, crowd, long_runs, instructions, python, left_out, footer)]
