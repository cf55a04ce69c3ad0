# SPDX-License-Identifier: BSD-3-Clause
"""Writes the pages of docs/papers: tables with the numbers of a paper next to those of this project. The module also finds stale lines."""
from __future__ import annotations

import math
import pathlib
from dataclasses import dataclass, field


@dataclass
class Table:
    """A table in Markdown. Each row describes one quantity and has one cell per column."""

    columns: list[str]
    rows: list[list[str]] = field(default_factory=list)

    def add(self, *cells: str) -> None:
        if len(cells) != len(self.columns):
            raise ValueError(f"row '{cells[0]}' has {len(cells)} cells; it must have {len(self.columns)}")
        self.rows.append(list(cells))

    def text(self) -> str:
        lines = ["| " + " | ".join(line) + " |" for line in (self.columns, *self.rows)]
        lines.insert(1, "|---" * len(self.columns) + "|")
        return "\n".join(lines) + "\n"


def number(value: float, digits: int = 3) -> str:
    """Returns a number rounded to significant digits; `-` for a missing number, `lost` if at least half of the simulated runs failed."""
    if math.isnan(value):
        return "-"
    if math.isinf(value):
        return "lost"
    if value == 0:
        return "0"
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    return f"{value:.{decimals}f}"


def change(value: float, base: float) -> str:
    """Returns the change relative to a base in percent, with its sign: -83.4 %."""
    if not (math.isfinite(value) and math.isfinite(base)) or base == 0:
        return "-"
    percent = 100 * (value / base - 1)
    return f"{percent:+.{1 if percent > -99.9 else 2}f} %".replace("-", "\u2212")


def share(value: float) -> str:
    return f"{100 * value:.1f} %"


def stale(written: str, now: str) -> list[str]:
    """Returns the lines of a page that differ from the current results, as `page has X, results give Y`."""
    old, new = written.splitlines(), now.splitlines()
    out = [f"line {k + 1}: page has '{a}', results give '{b}'" for k, (a, b) in enumerate(zip(old, new)) if a != b]
    if len(old) != len(new):
        out.append(f"page has {len(old)} lines, results give {len(new)}")
    return out


def finish(path: pathlib.Path, text: str, check: bool) -> list[str]:
    """Writes a page. With `check`, compares the text with the existing page and returns the lines that differ."""
    if not check:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return []
    if not path.is_file():
        return [f"{path} does not exist; run tools/reproduce without --check"]
    return [f"{path}: {line}" for line in stale(path.read_text(encoding="utf-8"), text)]
