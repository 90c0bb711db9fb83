"""A section of a report: its text, and the figures in it that were asked for."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Check:
    """A figure, what was asked of it and what was measured; relation: "at most" or "exactly"."""

    figure: str
    relation: str
    asked: float
    measured: float

    @property
    def met(self) -> bool:
        return self.measured == self.asked if self.relation == "exactly" else self.measured <= self.asked


@dataclass(frozen=True)
class Part:
    """Markdown that opens with its heading."""

    text: str
    checks: list[Check] = field(default_factory=list)
