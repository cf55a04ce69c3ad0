# SPDX-License-Identifier: BSD-3-Clause
"""Pages of docs/papers: tables with the paper's numbers next to ours, and the check that finds a stale cell."""
from __future__ import annotations

import math
import pathlib
from dataclasses import dataclass, field


@dataclass
class Table:
    """A table of Markdown. Each row is a quantity, one cell per column, and how our conditions differ from the paper's."""

    columns: list[str]
    rows: list[list[str]] = field(default_factory=list)

    def add(self, *cells: str) -> None:
        if len(cells) != len(self.columns):
            raise ValueError(f"row '{cells[0]}' has {len(cells)} cells, must have {len(self.columns)}")
        self.rows.append(list(cells))

    def text(self) -> str:
        lines = [self.columns, ["---"] * len(self.columns), *self.rows]
        return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def number(value: float, digits: int = 3) -> str:
    """Rounded to significant digits; `-` where there is no number, `lost` where the median draw failed."""
    if math.isnan(value):
        return "-"
    if math.isinf(value):
        return "lost"
    if value == 0:
        return "0"
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    return f"{value:.{decimals}f}"


def change(value: float, base: float) -> str:
    """Change against a base in percent with its sign: -83.4 %."""
    if not (math.isfinite(value) and math.isfinite(base)) or base == 0:
        return "-"
    percent = 100 * (value / base - 1)
    return f"{percent:+.{1 if percent > -99.9 else 2}f} %".replace("-", "\u2212")


def share(value: float) -> str:
    return f"{100 * value:.1f} %"


def stale(written: str, now: str) -> list[str]:
    """Lines of a page that differ from what the results give now, as `page has X, results give Y`."""
    old, new = written.splitlines(), now.splitlines()
    out = [f"line {k + 1}: page has '{a}', results give '{b}'" for k, (a, b) in enumerate(zip(old, new)) if a != b]
    if len(old) != len(new):
        out.append(f"page has {len(old)} lines, results give {len(new)}")
    return out


def finish(path: pathlib.Path, text: str, check: bool) -> list[str]:
    """Writes a page, or with `check` compares it with the one that is there and returns its stale lines."""
    if not check:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return []
    if not path.is_file():
        return [f"{path} is not there"]
    return [f"{path}: {line}" for line in stale(path.read_text(encoding="utf-8"), text)]
