"""A piece of work in a process of its own with a deadline: a hang or a crash is a result, not the end of the report."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from multiprocessing.connection import Connection
from typing import Any

FORK = multiprocessing.get_context("fork")


class Broken(str):
    """What went wrong with the process: "hangs", or "crashes" with the signal."""


def _answer(end: Connection, work: Callable[[Any], Any], item: Any) -> None:
    end.send(work(item))
    end.close()


def call(work: Callable[[Any], Any], item: Any, deadline: float) -> Any:
    """work(item), or Broken after `deadline` seconds or a crash."""
    ours, theirs = FORK.Pipe(duplex=False)
    process = FORK.Process(target=_answer, args=(theirs, work, item))
    process.start()
    theirs.close()
    try:
        return ours.recv() if ours.poll(deadline) else Broken(f"hangs: no answer within {deadline:g} s")
    except EOFError:
        process.join()
        return Broken(f"crashes: the process ended with exit code {process.exitcode}")
    finally:
        process.kill()
        process.join()


def call_each(work: Callable[[Any], Any], items: Sequence[Any], deadline: float) -> Iterator[tuple[Any, Any]]:
    """(item, result) in the order of the items, two at a time."""
    with ThreadPoolExecutor(2) as pool:
        yield from zip(items, pool.map(lambda item: call(work, item, deadline), items), strict=True)
