# SPDX-License-Identifier: BSD-3-Clause
"""Figures with Matplotlib: `pip install tumble[plots]`. Each function returns a Figure, which a notebook shows and `.savefig(path)` writes.
The functions do not use pyplot and leave its open figures unchanged."""
from __future__ import annotations

import importlib
from typing import Any

import numpy as np
import numpy.typing as npt

from .checks import having, refusal
from .errors import TumbleError
from .files import optional
from .placing import point_errors
from .recordings import Imu, Recording

Array = npt.NDArray[Any]

_GYRO, _OURS, _TRUE = "tab:pink", "tab:blue", "black"


def _figure(**options: Any) -> Any:
    optional("matplotlib", "plots")
    return importlib.import_module("matplotlib.figure").Figure(layout="constrained", **options)


def rate(imu: Imu, rates: Any, truth: Array | None = None, axes: str = "xyz") -> Any:
    """Plots angular velocity against time, one panel per axis of the IMU.

    Shows the gyro, `rates` (Rates, from tumble.rate) with a band of three standard deviations, and the truth (N, 3) if given. Times at
    which the gyro clips on an axis are shaded.
    """
    if not axes or set(axes) - set("xyz"):
        raise TumbleError(f"axes is '{axes}'; it must contain only x, y and z", "unknown", "axes", axes, "xyz")
    having("imu", imu, "an Imu such as recording.imus[0]", "time_ns", "gyro")
    having("rates", rates, "an object with rate, covariance and clipped_axes, such as the result of tumble.rate", "rate", "covariance", "clipped_axes")
    for name, rows in (("rates", rates.rate), ("truth", truth)):
        if rows is not None and np.shape(rows) != np.shape(imu.gyro):
            raise refusal("shape", name, np.shape(rows), np.shape(imu.gyro))
    figure = _figure(figsize=(9.0, 1.0 + 2.0 * len(axes)))
    t = (imu.time_ns - imu.time_ns[0]) * 1e-9
    panels = figure.subplots(len(axes), 1, sharex=True, squeeze=False)[:, 0]
    for panel, axis in zip(panels, axes, strict=True):
        j = "xyz".index(axis)
        clipped = (np.asarray(rates.clipped_axes) >> j & 1).astype(bool)
        panel.fill_between(t, 0, 1, where=clipped, transform=panel.get_xaxis_transform(), color="0.85", step="mid", lw=0, label="clipped")
        if truth is not None:
            panel.plot(t, truth[:, j], color=_TRUE, lw=1.6, label="truth")
        panel.plot(t, imu.gyro[:, j], color=_GYRO, lw=1.0, label="gyro")
        sigma = np.sqrt(rates.covariance[:, j, j])
        panel.plot(t, rates.rate[:, j], color=_OURS, lw=1.0, label="estimate")
        shown = np.where(np.isfinite(sigma), np.minimum(3 * sigma, 4 * np.abs(rates.rate).max()), np.nan)
        panel.fill_between(t, rates.rate[:, j] - shown, rates.rate[:, j] + shown, color=_OURS, alpha=0.25, lw=0, label="3 standard deviations")
        panel.set_ylabel(f"rate {axis} [rad/s]")
    panels[-1].set_xlabel("time [s]")
    panels[0].legend(loc="upper left", ncols=5, fontsize="small")
    return figure


def trajectory(poses: Any, truth: Any = None) -> Any:
    """Plots a trajectory from above and from the side.

    poses, truth: objects with `position` (N, 3), m (Poses, Trajectory, Truth). The truth is translated to the start of `poses`, without
    a rotation.
    """
    for name, given in (("poses", poses), ("truth", truth)):
        if given is not None or name == "poses":
            having(name, given, "an object with position", "position")
            if np.ndim(given.position) != 2 or np.shape(given.position)[1] != 3 or len(given.position) == 0:
                raise refusal("shape", f"{name}.position", np.shape(given.position), "(N, 3), N at least 1")
    figure = _figure(figsize=(9.0, 4.5))
    for panel, (a, b) in zip(figure.subplots(1, 2), ((0, 1), (0, 2)), strict=True):
        if truth is not None:
            moved = truth.position - truth.position[0] + poses.position[0]
            panel.plot(moved[:, a], moved[:, b], color=_TRUE, lw=2.0, label="truth")
        panel.plot(poses.position[:, a], poses.position[:, b], color=_OURS, lw=1.2, label="estimate")
        panel.plot(*poses.position[0, [a, b]], "o", color=_OURS, ms=5, label="start")
        panel.set(xlabel=f"{'xyz'[a]} [m]", ylabel=f"{'xyz'[b]} [m]", title="from above" if b == 1 else "from the side")
        panel.set_aspect("equal", adjustable="datalim")
    figure.axes[0].legend(fontsize="small")
    return figure


def map_by_error(recording: Recording, poses: Any, every: int = 10, worst_m: float | None = None) -> Any:
    """Plots the lidar's returns at the positions given by `poses` of the first IMU, from above and from the side.

    The colour of a return is its distance from the true position (`point_errors`). every=n uses every n-th return. worst_m: upper end of
    the colour scale; None: the 99 % quantile.
    """
    points, error_m = point_errors(recording, poses, every)
    figure = _figure(figsize=(10.0, 4.8))
    order = np.argsort(error_m)  # the returns with the largest errors are drawn last, on top
    top = float(np.quantile(error_m, 0.99)) if worst_m is None else worst_m
    for panel, (a, b) in zip(figure.subplots(1, 2), ((0, 1), (0, 2)), strict=True):
        dots = panel.scatter(points[order, a], points[order, b], c=error_m[order], s=0.6, lw=0, cmap="turbo", vmin=0.0, vmax=max(top, 1e-6))
        panel.set(xlabel=f"{'xyz'[a]} [m]", ylabel=f"{'xyz'[b]} [m]", title="from above" if b == 1 else "from the side")
        panel.set_aspect("equal", adjustable="datalim")
    figure.colorbar(dots, ax=figure.axes, label="distance from the truth [m]", shrink=0.9)
    return figure


def scores(frame: Any, metric: str, unit: str = "") -> Any:
    """Plots one metric of a sweep (`tumble.sweep`, `tumble.results`) by method on a logarithmic scale: one dot per draw, and a bar at the median.

    A draw that failed, or that has no value, appears as a cross at the top and counts as the worst value in the median. unit: unit of the axis;
    default: the unit at the end of the metric's name.
    """
    having("frame", frame, "a data frame from tumble.results", "metric", "kind", "method", "status", "value")
    rows = frame[frame.metric == metric]
    if len(rows) == 0:
        known = sorted(set(frame.metric.dropna()))
        raise TumbleError(f"metric is '{metric}'; it must be one of {', '.join(known)}", "unknown", "metric", metric, known)
    ended = frame[frame.kind.isin(set(rows.kind))].drop_duplicates(["scenario", "seed", "kind", "method"])
    values = {method: _values(ended[ended.method == method], rows[rows.method == method]) for method in sorted(set(ended.method))}
    finite = np.concatenate([each[np.isfinite(each)] for each in values.values()])
    if len(finite) == 0 or finite.max() <= 0.0:
        raise TumbleError(f"{metric} has no value above 0; a logarithmic scale needs at least one", "empty", metric, None, 0.0)
    least, most = max(finite[finite > 0].min(), 1e-12), finite.max()
    figure = _figure(figsize=(1.5 + 1.2 * len(values), 4.0))
    panel = figure.subplots()
    lost_at = 2.0 * most
    for k, each in enumerate(values.values()):
        spread = k + 0.3 * (np.arange(len(each)) / max(len(each) - 1, 1) - 0.5)
        kept = np.isfinite(each)
        panel.plot(spread[kept], np.maximum(each[kept], least), "o", ms=5, color=_OURS, alpha=0.7)
        panel.plot(spread[~kept], np.full((~kept).sum(), lost_at), "x", ms=7, color="tab:red")
        median = np.median(each)
        panel.hlines(median if np.isfinite(median) else lost_at, k - 0.3, k + 0.3, color=_TRUE, lw=2)
    panel.set_yscale("log")
    panel.set_xticks(range(len(values)), list(values), rotation=20)
    panel.set_ylabel(f"{metric.removesuffix('_rad_s').removesuffix('_rad').removesuffix('_m')} [{unit or _unit(metric)}]")
    return figure


def _values(ended: Any, rows: Any) -> Array:
    """Returns one value per draw. The value is infinite if the method failed or gave no value."""
    found = {(row.scenario, row.seed): row.value for row in rows.itertuples() if row.status == "ok" and row.value is not None}
    out = np.array([found.get((row.scenario, row.seed), np.inf) for row in ended.itertuples()], float)
    return np.where(np.isnan(out), np.inf, out)


def _unit(metric: str) -> str:
    units = {"_rad_s": "rad/s", "_m_s": "m/s", "_rad": "rad", "_m": "m", "_s": "s", "_mib": "MiB", "_share": "of the path"}
    return next((unit for end, unit in units.items() if metric.endswith(end)), "1")
