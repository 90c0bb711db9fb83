"""One look for every figure: type, colours, sizes in millimetres, and files equal byte for byte.

The type is STIX, which comes with matplotlib, so a figure looks the same on every machine.
The colours are those of Okabe and Ito, distinct for colour-blind readers and in grey print.
"""

from collections.abc import Sequence
from pathlib import Path

import matplotlib as mpl
import matplotlib.style
from matplotlib.axes import Axes
from matplotlib.figure import Figure

mpl.use("Agg")

BLUE = "#0072B2"
SKY = "#56B4E9"
VERMILLION = "#D55E00"
ORANGE = "#E69F00"
GREEN = "#009E73"
PURPLE = "#CC79A7"
INK = "#1A1A1A"
GREY = "#767676"
BAND = "#F6D9BF"  # VERMILLION at about a quarter, opaque: SVG and PNG then show one tone

MM = 1.0 / 25.4  # inch per millimetre
NOTE = 7.5  # points, the size of a note
COLUMN = 89.0  # mm, one journal column
PAGE = 183.0  # mm, two journal columns


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


def note(ax: Axes, text: str, at: Sequence[float], shift: Sequence[float], **how: object) -> None:
    """Small text beside the data point `at`, moved by `shift` in typographic points."""
    look = {"fontsize": NOTE, "textcoords": "offset points"} | how
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
