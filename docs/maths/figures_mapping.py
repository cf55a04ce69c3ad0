#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Generates the figures of mapping.md, rolling.md, attitude.md, imu_merge.md and statistics.md as SVG files.

Usage: python3 docs/maths/figures_mapping.py [NAME]...   (without a name: all figures; needs numpy and matplotlib)
"""
import math
import pathlib
import sys

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
import numpy as np
from statistics import NormalDist

HERE = pathlib.Path(__file__).resolve().parent
GREY, BLUE, RED, GREEN = "0.55", "#1f77b4", "#d62728", "#2ca02c"
plt.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "tumble", "font.size": 9, "font.family": "sans-serif",
                     "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False})


def arrow(axes, start, end, colour="k", width=1.4):
    axes.annotate("", xy=end, xytext=start,
                  arrowprops={"arrowstyle": "-|>", "color": colour, "lw": width, "shrinkA": 0, "shrinkB": 0})


def bare(axes):
    axes.set_aspect("equal")
    axes.axis("off")


def mapping_deficit():
    """Plots a saturated rate with its deficit at three knots, and the point-to-plane residual of a deskewed return."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.6, 3.2), gridspec_kw={"width_ratios": [1.25, 1]})
    duration, rail = 0.1, 35.0
    time = np.linspace(0.0, duration, 201)
    true = 20.0 + 27.0 * np.sin(np.pi * (time - 0.012) / 0.088) * (time > 0.012)
    read = np.minimum(true, rail)
    clipped = true > rail
    knots = np.array([0.0, duration / 2, duration])
    sigma = np.where(clipped, true - rail, 0.0)
    deficit = np.interp(time, knots, [6.0, 12.0, 8.0])
    left.plot(1e3 * time, true, color=GREY, ls="--", label="true rate")
    left.plot(1e3 * time, read, color="k", label="gyro reading w")
    left.plot(1e3 * time, read + sigma / sigma.max() * deficit, color=BLUE, label="rate used in (R7)")
    left.axhline(rail, color=RED, lw=0.8, ls=":")
    left.text(1.0, rail + 0.7, "gyro range", color=RED)
    for name, at in zip(("knot 0", "knot 1", "knot 2"), 1e3 * knots):
        left.axvline(at, color=GREEN, lw=0.8)
        left.text(at - 1.0 if at else at + 1.0, 8.5, name, color=GREEN, ha="right" if at else "left")
    left.set(xlabel="time in the segment [ms]", ylabel="rate [rad/s]", ylim=(7, 56))
    left.legend(loc="upper left", fontsize=8)

    s = np.linspace(0.0, 1.0, 60)
    path = np.stack([0.2 + 2.2 * s, 0.5 + 0.9 * s - 0.55 * s**2])
    right.plot(*path, color="k")
    start, now = path[:, 0], path[:, 36]
    hit, foot = np.array([3.25, 2.25]), np.array([3.02, 2.5])
    for point, text, shift in ((start, "start: p₀, v₀", (-0.1, -0.3)), (now, "IMU at time t", (0.1, -0.25))):
        right.plot(*point, "o", color="k", ms=4)
        right.text(*(point + shift), text)
    arrow(right, now, hit, BLUE)
    right.text(1.75, 1.55, "return", color=BLUE)
    along = np.array([0.74, 0.68])
    right.plot(*np.stack([foot - 1.0 * along, foot + 0.55 * along]).T, color=GREY, lw=2)
    right.text(1.15, 2.75, "plane (n, c) in the map", color="0.35")
    noise = np.random.default_rng(1).normal(0.0, 0.03, (9, 2))
    right.plot(*(foot + np.linspace(-0.9, 0.5, 9)[:, None] * along + noise).T, ".", color="0.35", ms=4)
    right.plot(*hit, "o", color=BLUE, ms=5)
    right.text(*(hit + (0.1, -0.12)), "X", color=BLUE)
    arrow(right, foot, hit, RED)
    right.text(3.22, 2.45, "r = n · (X − c)", color=RED)
    right.set(xlim=(-0.1, 4.5), ylim=(0.0, 3.2))
    bare(right)
    return figure


def rolling_contact():
    """Plots the geometry of the sphere, and the probability densities of the modes of motion."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.2, 3.3), gridspec_kw={"width_ratios": [1, 1.2]})
    centre, radius = np.array([0.0, 1.0]), 1.0
    left.add_patch(plt.Circle(centre, radius, fill=False, color="k", lw=1.4))
    left.plot([-1.5, 2.0], [0.0, 0.0], color=GREY, lw=2)
    imu = centre + (0.42, 0.38)
    contact = np.array([0.0, 0.0])
    arrow(left, centre, imu, BLUE)
    arrow(left, contact, contact + (0.0, 0.55), GREEN)
    arrow(left, contact, contact + (0.8, 0.0), RED)
    arrow(left, imu, imu + (0.95, -0.1), "k")
    left.plot(*centre, "o", color="k", ms=4)
    left.plot(*imu, "s", color=BLUE, ms=6)
    for at, text, colour in ((centre + (-0.2, 0.05), "G", "k"), (imu + (-0.12, 0.14), "IMU", BLUE),
                             (centre + (0.12, 0.02), "a = Rρ", BLUE), ((0.06, 0.4), "n", GREEN),
                             ((0.3, -0.2), "u (zero while gripping)", RED), (imu + (0.7, 0.05), "v", "k"),
                             ((-0.52, 0.42), "r", "k")):
        left.text(*at, text, color=colour)
    left.plot([0.0, -0.62], [1.0, 0.215], color=GREY, lw=1.0)
    left.add_patch(matplotlib.patches.Arc(centre, 2.5, 2.5, theta1=55, theta2=110, color="k"))
    arrow(left, centre + 1.25 * np.array([np.cos(0.98), np.sin(0.98)]),
          centre + 1.25 * np.array([np.cos(0.93), np.sin(0.93)]), "k")
    left.text(-0.2, 2.32, "w")
    left.set(xlim=(-1.6, 2.2), ylim=(-0.35, 2.55))
    bare(left)

    change = np.geomspace(5e-4, 0.5, 300)

    def mixture(parts):
        return sum(share * np.exp(-0.5 * (change / sigma)**2) / (2 * np.pi * sigma**2) for share, sigma in parts)

    parts = ((0.40, 0.004), (0.35, 0.01), (0.25, 0.08))
    right.loglog(change, mixture(parts), color="k", label="m₂ (slip, bump)")
    for part, name, colour in zip(parts, ("plateau", "drift", "jump"), (BLUE, GREEN, RED)):
        right.loglog(change, mixture((part,)), color=colour, ls="--", lw=0.9, label=name)
    right.set(xlabel="horizontal change of u from node to node [m/s]", ylabel="density [(m/s)⁻²]", ylim=(1e-2, 1e4))
    right.legend(fontsize=8)
    return figure


def attitude_growth():
    """Plots how a tilt error increases velocity and displacement, and the variance of a correlated rate error (A10)."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.2, 3.0))
    time = np.linspace(0.0, 3.0, 200)
    tilt = np.radians(2.0)
    left.plot(time, 9.80665 * tilt * time, color=BLUE, label="velocity v [m/s]")
    left.plot(time, 0.5 * 9.80665 * tilt * time**2, color=RED, label="displacement d [m]")
    left.axhspan(-0.3, 0.3, color=GREEN, alpha=0.2, lw=0)
    left.text(1.55, 0.05, "typical hand-held motion", color=GREEN)
    left.set(xlabel="time [s]", title="effect of a tilt error of 2°")
    left.legend(fontsize=8)

    memory, sigma = 0.05, 1.0
    time = np.geomspace(2e-3, 1.0, 200)
    right.loglog(time, 2 * sigma**2 * memory * (time - memory * (1 - np.exp(-time / memory))), color="k",
                 label="correlated error (A10)")
    right.loglog(time, sigma**2 * time**2, color=BLUE, ls="--", lw=1.0, label="constant error: σ² t²")
    right.loglog(time, 2 * sigma**2 * memory * time, color=RED, ls="--", lw=1.0, label="random walk: 2 σ² T t")
    right.set(xlabel="duration t of the saturation [s]", ylabel="variance of the angle [rad²]",
              title="rate error with σ = 1 rad/s, T = 0.05 s", ylim=(3e-6, 1.0))
    right.legend(fontsize=8)
    return figure


def imu_merge_rigid_body():
    """Plots four IMUs on a rotating body, and the rate that follows from the difference of two specific forces."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.2, 3.1))
    units = np.array([[1.0, 0.75], [-1.0, 0.75], [-1.0, -0.75], [1.0, -0.75]])
    left.add_patch(plt.Rectangle((-1.3, -1.05), 2.6, 2.1, fill=False, color=GREY, lw=1.4))
    for k, unit in enumerate(units):
        left.plot(*unit, "s", color=BLUE, ms=7)
        arrow(left, unit, 0.5 * unit, RED)
        left.text(*(unit + (0.1 if unit[0] > 0 else -0.25, 0.08)), f"{k + 1}", color=BLUE)
    left.plot(0, 0, "o", color="k", ms=4)
    left.text(0.07, -0.05, "p̄")
    left.text(0.15, 0.72, "w × (w × r)", color=RED)
    arrow(left, (0, 0), 0.45 * units[1], "k", 0.9)
    left.text(-0.38, 0.08, "r")
    left.add_patch(matplotlib.patches.Arc((0, 0), 3.5, 3.5, theta1=-20, theta2=20, color="k"))
    arrow(left, 1.75 * np.array([np.cos(0.33), np.sin(0.33)]), 1.75 * np.array([np.cos(0.37), np.sin(0.37)]))
    left.text(1.83, -0.05, "w")
    left.set(xlim=(-1.6, 2.1), ylim=(-1.2, 1.25))
    bare(left)

    rate = np.linspace(-60.0, 60.0, 200)
    for distance, colour in ((0.02, BLUE), (0.05, RED)):
        right.plot(rate, distance * rate**2, color=colour, label=f"distance {100 * distance:.0f} cm")
    right.axvspan(-35, 35, color=GREEN, alpha=0.15, lw=0)
    right.text(0, 130, "gyro range", color=GREEN, ha="center")
    right.set(xlabel="rate [rad/s]", ylabel="force difference of two units [m/s²]")
    right.legend(fontsize=8, loc="upper center")
    return figure


def statistics_sequence():
    """Plots the limits of the confidence sequence (S15) for 5 % risk, beyond which the share of positive pairs differs from one half."""
    risk, pairs = 0.05, 400
    normal, count, needed = NormalDist(), range(10, pairs + 1, 5), []
    for n in count:
        k = math.ceil(n / 2)
        while k < n and (n + 1) * math.comb(n, k) * 0.5**n > risk:
            k += 1
        needed.append(k)
    count = np.array(count)
    share = np.array(needed) / count
    figure, axes = plt.subplots(figsize=(6.4, 3.2))
    axes.plot(count, share, color=RED, label="limit of (S15)")
    axes.plot(count, 1.0 - share, color=RED)
    single = 0.5 + 0.5 * normal.inv_cdf(1.0 - risk / 2.0) / np.sqrt(count)
    axes.plot(count, single, color=GREY, ls="--", label="limit of a single test with 5 % risk")
    axes.plot(count, 1.0 - single, color=GREY, ls="--")
    axes.text(250, 0.72, "positive", color=RED)
    axes.text(250, 0.25, "negative", color=RED)
    axes.text(250, 0.49, "continue")
    axes.set(xlabel="nonzero pairs n", ylabel="share of positive pairs k/n", ylim=(0, 1), xlim=(0, pairs))
    axes.legend(fontsize=8, loc="lower right")
    return figure


FIGURES = {f.__name__: f for f in (mapping_deficit, rolling_contact, attitude_growth, imu_merge_rigid_body,
                                   statistics_sequence)}


def main(names):
    for name in names or FIGURES:
        if name not in FIGURES:
            sys.exit(f"figures_mapping.py: no figure {name!r}; figures: {', '.join(FIGURES)}")
        figure = FIGURES[name]()
        figure.tight_layout()
        figure.savefig(HERE / f"{name}.svg", metadata={"Date": None, "Creator": None})
        plt.close(figure)


if __name__ == "__main__":
    main(sys.argv[1:])
