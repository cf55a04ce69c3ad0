#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the figures of the notes on rates, rails, hand-held motion and clocks.

    python3 docs/maths/figures.py [NAME]

NAME is a note without its ending, for example `rails`; without NAME, all figures are drawn. Each figure is written to
docs/maths/NAME.png. Needs numpy, matplotlib and Pillow.
"""

import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import PIL.Image

FOLDER = pathlib.Path(__file__).parent
BLUE, RED, GREEN, GREY = "#1f6fb4", "#c8442f", "#3a8a4d", "#777777"


def panels(count, width=9.0, height=3.2):
    return plt.subplots(1, count, figsize=(width, height), layout="constrained")


def schematic(axes, title):
    axes.set_axis_off()
    axes.set_title(title, fontsize=10)


def rate_smoother():
    """Draws the factor graph of four samples, and the blocks of the normal matrix (R26)."""
    figure, (graph, matrix) = panels(2)
    schematic(graph, "factors of four samples")
    graph.set(xlim=(-0.8, 4.3), ylim=(-1.15, 2.6))
    graph.text(1.5, 2.3, "constants c", ha="center", va="center", bbox={"boxstyle": "round", "fc": "#fff3d6"})
    for k in range(4):
        graph.plot([k, 1.5], [1.0, 2.1], color="#bbbbbb", zorder=0)
        graph.text(k, 1.0, f"$x_{k}$", ha="center", va="center", bbox={"boxstyle": "circle", "fc": "#dbeafa"})
        graph.plot([k, k], [0.05, 0.75], color=GREY, zorder=0)
        graph.plot(k, 0.05, "s", color=RED if k == 2 else BLUE, ms=8)
        if k < 3:
            graph.plot([k + 0.25, k + 0.75], [1.0, 1.0], color=GREY, zorder=0)
            graph.plot(k + 0.5, 1.0, "s", color=GREEN, ms=7)
    for row, (colour, text) in enumerate(
        [
            (GREEN, "motion between samples (R4)"),
            (BLUE, "gyro, force, Euler's equation (R6, R10, R14)"),
            (RED, "bound of a saturated element (R9) instead of the gyro"),
        ]
    ):
        graph.plot(-0.6, -0.4 - 0.3 * row, "s", color=colour, ms=6)
        graph.text(-0.45, -0.4 - 0.3 * row, text, va="center", fontsize=8)
    size, border, count = 6, 20, 4
    filled = np.zeros((count * size + border,) * 2)
    for k in range(count):
        own = slice(k * size, (k + 1) * size)
        filled[own, own] = 1
        if k + 1 < count:
            after = slice((k + 1) * size, (k + 2) * size)
            filled[own, after] = filled[after, own] = 2
        filled[own, count * size :] = filled[count * size :, own] = 3
    filled[count * size :, count * size :] = 4
    colours = matplotlib.colors.ListedColormap(["white", "#dbeafa", "#cfe8d5", "#eeeeee", "#fff3d6"])
    matrix.pcolormesh(filled, cmap=colours)
    matrix.invert_yaxis()
    matrix.set_aspect("equal")
    for k in range(count):
        matrix.text((k + 0.5) * size, (k + 0.5) * size, f"$D_{k}$", ha="center", va="center")
        matrix.text(count * size + border / 2, (k + 0.5) * size, f"$B_{k}$", ha="center", va="center")
        if k + 1 < count:
            matrix.text((k + 1.5) * size, (k + 0.5) * size, f"$E_{k}$", ha="center", va="center")
    matrix.text(count * size + border / 2, count * size + border / 2, "$C$", ha="center", va="center")
    matrix.set(xticks=[], yticks=[])
    matrix.set_title("normal matrix (R26): 6 unknowns per sample, 20 constants", fontsize=10)
    return figure


def rails():
    """Plots readings of a gyro with tilted saturation limits (R50, R51), and the mean of a partly clipped window (R69)."""
    figure, (plane, window) = panels(2)
    rows = np.array([[1.0, 0.06], [-0.05, 1.0]])
    rail = 10.0
    time = np.linspace(0.0, 12.0, 900)
    rate = np.stack([15.0 * np.sin(1.7 * time), 8.0 * np.sin(2.9 * time + 1.0)], axis=1)
    sensed = rate @ rows.T
    clipped = np.abs(sensed[:, 0]) > rail
    reading = np.clip(sensed, -rail, rail) @ np.linalg.inv(rows).T
    plane.plot(*rate[clipped].T, ".", color="#cccccc", ms=3, label="true rate, saturated")
    plane.plot(*reading[~clipped].T, ".", color=BLUE, ms=3, label="free reading")
    plane.plot(*reading[clipped].T, ".", color=RED, ms=3, label="saturated reading")
    y = np.array([-9.0, 9.0])
    for sign in (-1, 1):
        plane.plot(sign * rail - rows[0, 1] * y, y, color="black", lw=0.8, zorder=0)
    plane.set(xlabel="x [rad/s]", ylabel="y [rad/s]", xlim=(-17, 17), ylim=(-10, 16))
    plane.legend(fontsize=7, loc="upper center", ncols=3, columnspacing=0.8, handletextpad=0.1)
    plane.set_title("tilted rail of the x element (slope 0.06)", fontsize=10)
    slope, share = 2.0, 0.6
    t = np.array([-1.0, 1.2])
    window.plot(t, rail + slope * (t - (1.0 - share)), color=GREY, label="true rate")
    window.axhline(rail, color="black", lw=0.8)
    window.text(-0.98, rail + 0.06, "rail c", fontsize=8)
    mean, truth = rail - (1 - share) ** 2 * slope / 2, rail + (share - 0.5) * slope
    window.fill_between(
        [1.0 - share, 1.0], [rail, rail], [rail, rail + slope * share], color="#f3d3cd", label="hidden part"
    )
    window.plot([0, 1], [mean] * 2, color=RED, lw=2, label="reading m")
    window.plot([0, 1], [truth] * 2, color=GREEN, lw=2, ls="--", label="true mean")
    window.plot([-1, 0], [truth - slope] * 2, color=BLUE, lw=2, label="neighbour n")
    window.annotate("", (0.12, truth), (0.12, mean), arrowprops={"arrowstyle": "<->", "lw": 0.8})
    window.text(0.16, 0.5 * (mean + truth) - 0.12, "lost", fontsize=8)
    window.set(xlabel="time [windows]", ylabel="rate along the row [rad/s]", xlim=(-1, 1.2))
    window.legend(fontsize=7, loc="lower right")
    window.set_title("window saturated for the share p = 0.6", fontsize=10)
    return figure


def rate_stream():
    """Plots the sliding window, and the parabola of the true rate during saturation (R99)."""
    figure, (window, run) = panels(2)
    schematic(window, "sliding window")
    window.set(xlim=(-0.3, 10.3), ylim=(-1.0, 2.3))
    for k in range(11):
        inside = 2 <= k <= 8
        window.text(
            k,
            1.0,
            "x",
            ha="center",
            va="center",
            color="black" if inside else "#aaaaaa",
            bbox={"boxstyle": "circle", "fc": "#dbeafa" if inside else "white", "ec": "black" if inside else "#aaaaaa"},
        )
    window.annotate("", (2, 1.75), (8, 1.75), arrowprops={"arrowstyle": "<->"})
    window.text(5, 1.9, "window: one Gauss-Newton step per 5 ms", ha="center", fontsize=8)
    for x, y, text in [
        (0.5, 0.1, "marginalised\n(R90)"),
        (2.2, -0.8, "prior (R91),\nreported at the age lag_s"),
        (8.0, 0.1, "newest sample:\nprovisional rate"),
        (9.7, -0.8, "future"),
    ]:
        window.text(x, y, text, ha="center", fontsize=8)
    window.annotate("", (2, 0.7), (2, -0.25), arrowprops={"arrowstyle": "->", "color": GREY})
    rail, slope, count = 10.0, 0.8, 12
    k = np.arange(-4, count + 4)
    hidden = np.where((k >= 0) & (k < count), slope * (k + 0.5) * (count - k - 0.5) / count, 0.0)
    outside = np.where(k < 0, slope * (k + 0.5), np.where(k >= count, -slope * (k - count + 0.5), 0.0))
    run.plot(k, rail + outside, "o", color=BLUE, ms=4, label="reading")
    inside = (k >= 0) & (k < count)
    run.plot(k[inside], rail + hidden[inside], color=RED, label="hidden by the slopes: max(a, a') u v / (u + v)")
    run.fill_between(k[inside], rail, rail + hidden[inside], color="#f3d3cd")
    run.axhline(rail, color="black", lw=0.8)
    run.set(xlabel="sample", ylabel="rate [rad/s]")
    run.legend(fontsize=7, loc="lower center")
    run.set_title("saturated run in contact (R99)", fontsize=10)
    return figure


def carried():
    """Plots rates that differ by whole revolutions (C28), and the likelihoods of the regimes (C31 to C34)."""
    figure, (turns, regimes) = panels(2)
    rail, span = 10.0, 0.6
    t = np.linspace(-0.2, span + 0.2, 400)
    base = rail + 9.0 - 9.0 * ((t - span / 2) / (span / 2)) ** 2
    u = np.clip(t / span, 0.0, 1.0)
    for n, colour in [(-1, GREY), (0, BLUE), (1, RED)]:
        rate = base + np.where((t > 0) & (t < span), 2 * np.pi * n / span * (1 - np.cos(2 * np.pi * u)), 0.0)
        turns.plot(t, rate, color=colour, label=f"n = {n:+d}" if n else "n = 0")
    turns.axhline(rail, color="black", lw=0.8)
    turns.text(-0.19, rail + 0.5, "rail", fontsize=8)
    turns.axvspan(0, span, color="#f5f5f5", zorder=0)
    turns.set(xlabel="time [s]", ylabel="rate of the saturated element [rad/s]")
    turns.legend(fontsize=8)
    turns.set_title("revolutions hidden by a saturated segment", fontsize=10)
    n, g = np.linspace(0.02, 40.0, 800), 9.81
    gaussian = lambda square, variance: (2 * np.pi * variance) ** -1.5 * np.exp(-0.5 * square / variance)

    def about_gravity(variance):
        x = n * g / variance
        log = (
            -1.5 * np.log(2 * np.pi * variance)
            - (n**2 + g**2) / (2 * variance)
            + x
            - np.log(2 * x)
            + np.log1p(-np.exp(-2 * x))
        )
        return np.exp(log)

    flight = gaussian(n**2, 0.3**2)
    hand = 2 / 3 * about_gravity(25.0) + 1 / 3 * about_gravity(625.0)
    within = np.maximum(n, 1.0)
    contact = 0.5 / (4 * np.pi * within**3 * np.log(1000.0)) + 0.5 * about_gravity(25.0)
    for density, colour, name in [(flight, BLUE, "flight"), (contact, RED, "contact"), (hand, GREEN, "hand")]:
        regimes.semilogy(n, density, color=colour, label=name)
    regimes.set(xlabel="norm of the specific force [m/s²]", ylabel="density [(m/s²)⁻³]", ylim=(1e-7, 10.0))
    regimes.legend(fontsize=8)
    regimes.set_title("likelihood of the three regimes (slow rotation)", fontsize=10)
    return figure


def rotation(angle):
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def saave():
    """Plots the geometry of S1, and the sensitivity S4."""
    figure, (geometry, sensitivity) = panels(2)
    schematic(geometry, "lever arm and rotation axis")
    geometry.set(xlim=(-0.6, 2.9), ylim=(-0.4, 2.3), aspect="equal")
    axis = np.array([0.35, 1.0]) / np.hypot(0.35, 1.0)
    lever = np.array([1.9, 0.9])
    foot = axis * (lever @ axis)
    geometry.plot(*np.array([-0.3 * axis, 2.3 * axis]).T, color=GREY, ls="--")
    for begin, end, colour, text, offset in [
        ((0, 0), lever, BLUE, "t", (0.05, -0.22)),
        (lever, foot, RED, "l", (0.05, 0.1)),
        ((0, 0), 0.8 * axis, GREEN, "e", (-0.22, 0.0)),
    ]:
        geometry.annotate("", end, begin, arrowprops={"arrowstyle": "->", "color": colour, "lw": 1.8})
        geometry.text(*(0.5 * (np.array(begin) + np.array(end)) + np.array(offset)), text, color=colour, fontsize=12)
    geometry.plot(0, 0, "ko", ms=5)
    geometry.plot(*lever, "ks", ms=6)
    geometry.text(0.08, -0.25, "centre of mass", fontsize=8)
    geometry.text(lever[0] - 0.1, lever[1] - 0.3, "IMU", fontsize=8)
    geometry.text(*(2.1 * axis + np.array([0.1, 0.0])), "rotation axis", fontsize=8)
    arm = np.linspace(0.005, 0.2, 200)
    for rate, colour in [(5.0, RED), (10.0, BLUE), (20.0, GREEN)]:
        sensitivity.semilogy(arm, 0.1 / (2 * arm * rate), color=colour, label=f"|w| = {rate:.0f} rad/s")
    sensitivity.set(xlabel="|l| [m]", ylabel="rate error [rad/s]")
    sensitivity.legend(fontsize=8)
    sensitivity.set_title("rate error for a force error of 0.1 m/s² (S4)", fontsize=10)
    return figure


def sample_clock():
    """Plots S1 to S3 for time stamps with jitter, started with the true line of 32 time stamps."""
    figure, axes = panels(1, width=7.0)
    generator = np.random.default_rng(1)
    period, memory, count, start = 0.01, 2.0, 800, 32
    stamps = period * np.arange(count) + 0.0005 * generator.standard_normal(count)
    numbers = np.arange(start) - (start - 1)
    slope, line = np.polyfit(numbers, stamps[:start], 1)
    sums = [start, numbers.sum(), (numbers**2).sum()]
    times = list(stamps[:start])
    for stamp in stamps[start:]:
        step = max(1, round((stamp - line) / slope))
        error = stamp - (line + step * slope)
        keep = 1.0 - min(0.5, step * slope / memory)
        sums = [
            keep * sums[0] + 1.0,
            keep * (sums[1] - step * sums[0]),
            keep * (sums[2] - 2 * step * sums[1] + step**2 * sums[0]),
        ]
        determinant = sums[0] * sums[2] - sums[1] ** 2
        line += step * slope + sums[2] / determinant * error
        slope -= sums[1] / determinant * error
        times.append(line)
    truth = period * np.arange(count)
    axes.plot(truth, 1e3 * (stamps - truth), ".", color="#bbbbbb", ms=3, label="stamp")
    axes.plot(truth, 1e3 * (np.array(times) - truth), color=BLUE, lw=1.2, label="estimated time")
    deviation = 1e3 * 0.0005 * np.sqrt(1.25 * period / memory)
    for sign in (-1, 1):
        axes.axhline(sign * deviation, color=RED, lw=0.8, label="deviation by S4" if sign > 0 else None)
    axes.set(xlabel="time [s]", ylabel="error [ms]")
    axes.legend(fontsize=8, loc="upper right")
    return figure


FIGURES = {f.__name__: f for f in (rate_smoother, rails, rate_stream, carried, saave, sample_clock)}


def main(names):
    unknown = [name for name in names if name not in FIGURES]
    if unknown:
        sys.exit(f"unknown figure {unknown[0]}: one of {', '.join(FIGURES)}")
    plt.rcParams.update({"font.size": 9})
    for name in names or FIGURES:
        figure = FIGURES[name]()
        figure.savefig(FOLDER / f"{name}.png", dpi=110)
        plt.close(figure)
        picture = PIL.Image.open(FOLDER / f"{name}.png").convert("RGB")
        picture.quantize(64).save(FOLDER / f"{name}.png", optimize=True)  # a third of the size


if __name__ == "__main__":
    main(sys.argv[1:])
