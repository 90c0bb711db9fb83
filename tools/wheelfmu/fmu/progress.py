"""The progress bar: on stderr, only on a terminal; the variable TQDM_DISABLE=1 hides it there too."""

import sys
from collections.abc import Iterable
from threading import RLock
from typing import Any

from tqdm import tqdm

# For threads alone: the usual lock is a semaphore between processes, which Python tracks by one more process.
tqdm.set_lock(RLock())


def bar(steps: Iterable[Any] | None = None, shown: bool = True, **look: Any) -> tqdm:
    hidden = {} if shown and sys.stderr.isatty() else {"disable": True}  # on a terminal the variable decides
    return tqdm(steps, **look, **hidden)
