"""One look for every figure: type, colours, sizes in millimetres, and files equal byte for byte.

The type is STIX, which comes with matplotlib, so a figure looks the same on every machine.
The colours are those of Okabe and Ito, distinct for colour-blind readers and in grey print, with a purple of more
contrast. `colours.json` has them, and that of each quantity, also for the browser page.
"""

import json
import sys
from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.style
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import StepPatch
from numpy.typing import ArrayLike

if "ipykernel" not in sys.modules:  # a notebook shows what it draws
    mpl.use("Agg")

COLOURS = json.loads(Path(__file__).with_name("colours.json").read_text(encoding="utf-8"))
PALETTE = {name: tone["light"] for name, tone in COLOURS["palette"].items()}
BLUE, SKY, VERMILLION, ORANGE = (PALETTE[name] for name in ("blue", "sky", "vermillion", "orange"))
GREEN, PURPLE, INK, GREY = (PALETTE[name] for name in ("green", "purple", "ink", "grey"))

Look = dict[str, Any]  # keywords of matplotlib

MM = 1.0 / 25.4  # inch per millimetre
STRIP = 0.025  # of the axes: the height of a mark at the margin
NOTE = 7.5  # points, the size of a note
COLUMN = 89.0  # mm, one journal column
PAGE = 183.0  # mm, two journal columns


def colour(quantity: str) -> str:
    """Of a quantity or state, such as `v`, `held`, `slide`: one in all pictures."""
    return PALETTE[COLOURS["quantities"][quantity]]


def use_style() -> None:
    """Set the look for all figures made afterwards."""
    mpl.rcdefaults()
    mpl.style.use(Path(__file__).parent / "wheel.mplstyle")


def figure_mm(width: float, height: float) -> Figure:
    """An empty figure of this size in mm."""
    return Figure(figsize=(width * MM, height * MM))


def axes_mm(fig: Figure, left: float, bottom: float, width: float, height: float) -> Axes:
    """Axes whose frame has this place and size in mm from the figure's lower left corner."""
    w, h = (size / MM for size in fig.get_size_inches())
    return fig.add_axes((left / w, bottom / h, width / w, height / h))


def strip(ax: Axes, edges: ArrayLike, shown: ArrayLike, color: str, top: bool = False) -> None:
    """A mark at the lower or upper margin of a time axis where `shown`, between each two edges."""
    low, high = (1.0 - STRIP, 1.0) if top else (0.0, STRIP)
    heights = np.where(shown, high, low)
    place: Look = {"transform": ax.get_xaxis_transform()}
    ax.add_artist(StepPatch(heights, edges, baseline=low, fill=True, color=color, linewidth=0, zorder=1, **place))


def note(ax: Axes, text: str, at: tuple[float, float], shift: tuple[float, float], **how: Any) -> None:
    """Small text beside the data point `at`, moved by `shift` in typographic points."""
    look: Look = {"fontsize": NOTE, "textcoords": "offset points"} | how
    ax.annotate(text, at, xytext=shift, **look)


def save(fig: Figure, stem: Path, dpi: int = 300) -> list[Path]:
    """Write stem.svg and stem.png without date or program version; return both paths."""
    png = save_png(fig, stem.with_suffix(".png"), dpi)
    fig.savefig(stem.with_suffix(".svg"), dpi=dpi, metadata={"Date": None, "Creator": None})
    return [stem.with_suffix(".svg"), png]


def save_png(fig: Figure, path: Path, dpi: int = 200) -> Path:
    """The same bytes for the same picture."""
    path.parent.mkdir(parents=True, exist_ok=True)
    fig.savefig(path, dpi=dpi, metadata={"Software": None})
    return path
