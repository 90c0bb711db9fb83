"""python3 tools COMMAND [WORD...]: answers --help and typing errors, and writes to file descriptor 3, if it is open, a
full stop and the words of set-up that the command needs. By the standard library alone, before anything is installed.
"""

import os
import sys
from contextlib import suppress
from pathlib import Path

from wheelfmu.__main__ import needs

sys.path.append(str(Path(__file__).resolve().parents[1]))  # of the lab's commands; .venv has it once it is made
words = needs(*sys.argv[1:])
if words is not None:
    with suppress(OSError):
        os.write(3, " ".join((".", *words)).encode())
