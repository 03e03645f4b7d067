"""What was measured: one line per check, the worst value beside its limit."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import isnan


@dataclass
class Line:
    """One check, gathered over all sheets, parts or slits it was applied to."""

    unit: str
    limit: float
    worst: float
    where: str = ""
    count: int = 0
    lower: bool = False
    problems: list[str] = field(default_factory=list)

    def holds(self) -> bool:
        if self.problems or isnan(self.worst):
            return False
        return self.worst >= self.limit if self.lower else self.worst <= self.limit


class Report:
    """Collects checks by name; the same name may be measured many times and keeps its worst."""

    def __init__(self) -> None:
        self.lines: dict[str, Line] = {}

    def at_most(self, name: str, value: float, limit: float, where: str = "", unit: str = "mm", count: int = 1) -> None:
        line = self.lines.setdefault(name, Line(unit, limit, 0.0))
        line.count += count
        if isnan(value) or value > line.worst:
            line.worst, line.where = value, where

    def at_least(self, name: str, value: float, limit: float, where: str = "", unit: str = "mm", count: int = 1) -> None:
        line = self.lines.setdefault(name, Line(unit, limit, float("inf"), lower=True))
        line.count += count
        if isnan(value) or value < line.worst:
            line.worst, line.where = value, where

    def claim(self, name: str, problems: list[str], count: int = 1) -> None:
        """A yes-or-no check; `problems` lists what speaks against it."""
        line = self.lines.setdefault(name, Line("problems", 0, 0))
        line.count += count
        line.problems += problems
        line.worst = len(line.problems)

    def misses(self) -> list[str]:
        return [name for name, line in self.lines.items() if not line.holds()]

    def text(self) -> str:
        rows = []
        for name, line in self.lines.items():
            sign = ">=" if line.lower else "<="
            mark = "ok  " if line.holds() else "MISS"
            # The place matters only for a miss; shown for all, it would drown the numbers.
            place = f"  at {line.where}" if line.where and not line.holds() else ""
            rows.append(f"{mark} {name:<40} worst {line.worst:<10.4g} {sign} {line.limit:g} {line.unit} (of {line.count}){place}")
            rows += [f"       {problem}" for problem in line.problems[:8]]
            if len(line.problems) > 8:
                rows.append(f"       ... and {len(line.problems) - 8} more")
        return "\n".join(rows)
