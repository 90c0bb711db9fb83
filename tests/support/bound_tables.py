"""The part of pytest that gathers the measured values, from all processes of a run, and compares or records them."""

from __future__ import annotations

import pytest

from support import bounds

gathered: set[str] = set()  # files of which a test has run
failed: set[str] = set()  # and those of which one has failed: nothing is compared there
faults: list[str] = []


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--record", action="store_true", help="write what was measured into each folder's bounds.csv")


def whole(config: pytest.Config) -> bool:
    """Whole files were run: no test was picked out."""
    options = config.option
    chosen = options.keyword or options.markexpr or options.deselect or getattr(options, "lf", False)
    return not (chosen or "::" in " ".join(config.args))


def pytest_configure(config: pytest.Config) -> None:
    if config.option.record and not whole(config):
        raise pytest.UsageError("--record needs whole files: without -k, -m, --lf and ::")


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    file = report.nodeid.split("::")[0]
    gathered.add(file)
    if report.failed:
        failed.add(file)


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node) -> None:
    for key, bound, measured in node.workeroutput.get("bounds", ()) if hasattr(node, "workeroutput") else ():
        bounds.note(tuple(key), bounds.Row(bound, measured))


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish(session: pytest.Session) -> None:
    config = session.config
    if hasattr(config, "workeroutput"):
        config.workeroutput["bounds"] = [(key, row.bound, row.measured) for key, row in bounds.seen.items()]
        return
    if session.exitstatus not in (pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED):
        return
    for table in sorted({bounds.table_of(file) for file in gathered}):
        rows = bounds.read(config.rootpath, table)
        gone = {key[0] for key in rows if not (config.rootpath / key[0]).exists()}
        files = {file for file in gathered - failed if bounds.table_of(file) == table} | gone
        if config.option.record:
            rows = bounds.recorded(rows, files)
            bounds.write(config.rootpath / table, rows)
        faults.extend(bounds.faults(rows, files, whole(config)))
    if faults:
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


def pytest_terminal_summary(terminalreporter) -> None:
    if faults:
        terminalreporter.section("bounds: pytest --record writes what was measured; a reason is written by hand")
        for fault in faults:
            terminalreporter.write_line(fault, red=True)
