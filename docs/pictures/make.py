#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the diagrams of docs/how_it_works.md and README.md. Needs Debian's python3-matplotlib.

    /usr/bin/python3 docs/pictures/make.py [idea|data_flow|factor_graph]...
"""
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import FancyBboxPatch, Rectangle

HERE = pathlib.Path(__file__).resolve().parent
INK, BLUE, ORANGE, GREEN, GREY = "#222222", "#1f6fb4", "#d9641e", "#2d8a4e", "#8a8a8a"
plt.rcParams.update({"font.size": 9, "svg.hashsalt": "tumble", "svg.fonttype": "path", "axes.edgecolor": GREY})


def save(figure, name):
    figure.savefig(HERE / f"{name}.svg", metadata={"Date": None}, facecolor="white")
    plt.close(figure)


def idea():
    """Plots the three measurements that recover a clipped rate."""
    figure, (flight, rail, deficit) = plt.subplots(1, 3, figsize=(9.6, 2.9))
    t = np.linspace(0.0, 1.0, 400)
    rate = 9.0 + 7.0 * np.exp(-(((t - 0.5) / 0.2) ** 2))

    flight.plot(t, 0.1 * rate**2, color=GREEN)
    flight.set_title("Free flight: the accelerometer\nmeasures the spin", color=GREEN)
    flight.set_ylabel("specific force [m/s²]")
    flight.text(0.03, 0.93, r"$f = \dot\omega\times r + \omega\times(\omega\times r)$", transform=flight.transAxes, va="top")
    flight.set_ylim(0, 38)

    rail.plot(t, rate, color=INK, label="true rate")
    rail.plot(t, np.minimum(rate, 10.5), color=ORANGE, lw=2, label="gyro reading")
    rail.fill_between(t, 10.5, 19, where=rate > 10.5, color=ORANGE, alpha=0.15, lw=0, label="allowed by the bound")
    rail.set_title("Saturation: a clipped reading\nis a lower bound", color=ORANGE)
    rail.set_ylabel("angular rate [rad/s]")
    rail.set_ylim(7, 22)
    rail.legend(frameon=False, fontsize=7, loc="upper right")

    ground = 0.25 * np.sin(5 * t)
    deficit.plot(t, ground, color=GREY, lw=3, label="map surface")
    deficit.plot(t[::9], (ground + 0.55 * t**2)[::9], ".", color=ORANGE, ms=3, label="sweep with the clipped rate")
    deficit.plot(t[::9], (ground + 0.02 * np.sin(60 * t))[::9], ".", color=BLUE, ms=3, label="with the estimated deficit")
    deficit.set_title("Registration: the missing rate\nis an unknown of the sweep", color=BLUE)
    deficit.set_ylabel("height [m]")
    deficit.set_ylim(-0.5, 1.35)
    deficit.legend(frameon=False, fontsize=7, loc="upper left", markerscale=4)
    for axis in (flight, rail):
        axis.set_xlabel("time [s]")
    deficit.set_xlabel("time within one sweep (share)")
    figure.tight_layout()
    save(figure, "idea")


def box(axis, x, y, text, color, w=1.7, h=0.62):
    axis.add_patch(FancyBboxPatch((x - w / 2, y - h / 2), w, h, boxstyle="round,pad=0.03", fc="white", ec=color, lw=1.4))
    axis.text(x, y, text, ha="center", va="center", color=INK)


def arrow(axis, start, end, text="", color=GREY, at=0.5, shift=(0.0, 0.12)):
    axis.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": color, "lw": 1.2})
    if text:
        axis.text(start[0] + at * (end[0] - start[0]) + shift[0], start[1] + at * (end[1] - start[1]) + shift[1], text,
                  ha="center", va="center", fontsize=7.5, color=color)


def data_flow():
    """Draws the data flow in TumblingOdometry and RollingOdometry."""
    figure, axis = plt.subplots(figsize=(9.6, 4.3))
    axis.set_xlim(0, 12)
    axis.set_ylim(0, 5.4)
    axis.axis("off")
    box(axis, 1.0, 3.7, "IMU samples", GREY)
    box(axis, 1.0, 2.5, "lidar sweeps", GREY)
    box(axis, 3.6, 3.7, "clock and\nsaturation limits", ORANGE)
    box(axis, 6.2, 3.7, "rate estimator\n(flight, contact, hand-held)", GREEN, w=2.3)
    box(axis, 6.2, 2.5, "deskewing", BLUE)
    box(axis, 8.9, 2.5, "registration\n(pose, velocity, deficit)", BLUE, w=2.2)
    box(axis, 11.1, 2.5, "map", BLUE, w=1.2)
    box(axis, 8.9, 4.75, "pose, velocity, covariance", INK, w=2.4)
    arrow(axis, (1.9, 3.7), (2.7, 3.7))
    arrow(axis, (4.5, 3.7), (5.0, 3.7), "flags", shift=(0, 0.16))
    arrow(axis, (6.2, 3.36), (6.2, 2.84), "rate and covariance", shift=(0.85, 0))
    arrow(axis, (1.9, 2.5), (5.3, 2.5))
    arrow(axis, (7.1, 2.5), (7.75, 2.5))
    arrow(axis, (10.05, 2.62), (10.46, 2.62), "insert", shift=(0, 0.17))
    arrow(axis, (10.46, 2.38), (10.05, 2.38), "planes", shift=(0, -0.17))
    arrow(axis, (8.9, 2.86), (8.9, 4.41), "one pose per sweep", shift=(0.95, 0))
    arrow(axis, (7.0, 4.04), (7.75, 4.6), "inertial propagation", shift=(-0.95, 0.1))
    box(axis, 1.0, 0.75, "1 to 4 IMUs\nin a sphere", GREY)
    box(axis, 3.6, 0.75, "merge, detect\nfailed units", ORANGE)
    box(axis, 6.2, 0.75, "rolling filter\n(grip, slip, bump, incline)", GREEN, w=2.1)
    box(axis, 8.9, 0.75, "fixed-lag smoother", GREEN)
    box(axis, 11.1, 0.75, "pose", INK, w=1.2)
    for start, end in ((1.9, 2.7), (4.5, 5.1), (7.3, 8.0), (9.8, 10.46)):
        arrow(axis, (start, 0.75), (end, 0.75))
    axis.text(0.05, 5.1, "TumblingOdometry", weight="bold", color=INK)
    axis.text(0.05, 1.45, "RollingOdometry", weight="bold", color=INK)
    figure.tight_layout(pad=0.2)
    save(figure, "data_flow")


def factor_graph():
    """Draws the unknowns (circles) and factors (squares) of the rate smoother."""
    figure, axis = plt.subplots(figsize=(9.6, 3.6))
    axis.set_xlim(0, 12)
    axis.set_ylim(0, 4.6)
    axis.axis("off")
    axis.set_aspect("equal")
    xs = (1.5, 4.0, 6.5, 9.0)
    constants = (6.0, 4.1)

    def square(x, y, color):
        axis.add_patch(Rectangle((x - 0.11, y - 0.11), 0.22, 0.22, fc=color, ec=color, zorder=3))

    def line(a, b):
        axis.plot([a[0], b[0]], [a[1], b[1]], color=GREY, lw=0.8, zorder=1)

    def circle(x, y, text, r=0.42):
        axis.add_patch(plt.Circle((x, y), r, fc="white", ec=INK, lw=1.4, zorder=2))
        axis.text(x, y, text, ha="center", va="center", zorder=4)

    for k, x in enumerate(xs):
        circle(x, 2.0, f"$\\omega_{k},\\dot\\omega_{k}$", 0.5)
        for shift, color, to_constants in ((-0.55, ORANGE if k in (1, 2) else BLUE, False), (0.0, GREEN, True)):
            y = 0.75 if not to_constants else 3.05
            square(x + shift, y, color)
            line((x + shift, y), (x, 2.0))
            if to_constants:
                line((x + shift, y), constants)
        if k + 1 < len(xs):
            middle = 0.5 * (x + xs[k + 1])
            square(middle, 2.0, GREY)
            line((x, 2.0), (middle, 2.0))
            line((middle, 2.0), (xs[k + 1], 2.0))
    circle(*constants, "$r, b_g, b_a, J$", 0.45)
    square(constants[0] - 1.6, constants[1], GREY)
    line((constants[0] - 1.6, constants[1]), constants)
    for y, color, text in ((3.9, GREEN, "specific force,\nEuler's equation"), (3.0, GREY, "motion model,\nprior"),
                           (2.1, BLUE, "gyro reading"), (1.4, ORANGE, "bound of a\nclipped reading")):
        square(10.15, y, color)
        axis.text(10.4, y, text, va="center", fontsize=8)
    axis.text(xs[0], 0.25, "not clipped", ha="center", fontsize=8, color=BLUE)
    axis.text(0.5 * (xs[1] + xs[2]), 0.25, "clipped", ha="center", fontsize=8, color=ORANGE)
    axis.text(xs[3], 0.25, "not clipped", ha="center", fontsize=8, color=BLUE)
    figure.tight_layout(pad=0.2)
    save(figure, "factor_graph")


if __name__ == "__main__":
    for name in sys.argv[1:] or ("idea", "data_flow", "factor_graph"):
        {"idea": idea, "data_flow": data_flow, "factor_graph": factor_graph}[name]()
