# SPDX-License-Identifier: BSD-3-Clause
"""Draws the figures of docs/papers in one style and with small files."""
from __future__ import annotations

import io
import pathlib

import numpy as np

TRUTH, RAW, PUBLISHED, OURS, LIVE = "black", "tab:red", "tab:orange", "tab:blue", "tab:cyan"


def panels(rows: int, columns: int, width_in: float, height_in: float, **options: object) -> tuple:
    """Returns a figure and its array of axes, with a light grid."""
    from matplotlib.figure import Figure  # imported here, because a check of numbers needs no figures

    figure = Figure(figsize=(width_in, height_in), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False, **options)
    for panel in axes.flat:
        panel.grid(True, color="0.9", lw=0.6)
        panel.set_axisbelow(True)
    return figure, axes


def legend(figure: object, panel: object, columns: int) -> None:
    """Adds one legend for all panels, in a strip above the panels."""
    strip_in = 0.34
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - strip_in / figure.get_figheight()))
    figure.legend(*panel.get_legend_handles_labels(), loc="upper center", ncols=columns, fontsize="small")


def save(figure: object, path: pathlib.Path, palette: bool = True) -> None:
    """Writes a PNG. A palette of 128 colours needs a third of the bytes, but drops rare colours of a picture of points."""
    from PIL import Image

    figure.draw_without_rendering()  # the first drawing computes the size of the tick labels, which the layout needs
    memory = io.BytesIO()
    figure.savefig(memory, format="png", dpi=100)
    path.parent.mkdir(parents=True, exist_ok=True)
    image = Image.open(memory).convert("RGB")
    if palette:
        image = image.quantize(128, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    image.save(path, optimize=True)


def percentiles(panel: object, values: list[float], label: str, colour: str, limit: float) -> None:
    """Plots values against their percentile. Values above `limit`, and those of failed runs, are drawn at `limit`."""
    ordered = np.minimum(np.sort(values), limit)
    panel.plot(100 * (np.arange(len(ordered)) + 0.5) / len(ordered), ordered, color=colour, label=label, marker=".", ms=4, lw=1.4)
