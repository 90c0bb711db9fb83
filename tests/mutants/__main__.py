"""python -m mutants [COUNT [SEED]] | named [WORD...]; see ./scripts/mutants."""

from __future__ import annotations

import sys

from mutants import named, random_ones

if sys.argv[1:2] == ["named"]:
    sys.exit(named.main(sys.argv[2:]))
numbers = [*map(int, sys.argv[1:]), *(500, 1)[len(sys.argv) - 1 :]]
sys.exit(random_ones.main(*numbers))
