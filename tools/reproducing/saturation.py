# SPDX-License-Identifier: BSD-3-Clause
"""Scores the methods for angular velocity on a real gyro that stays saturated for seconds.

The recording is a rocket with three rigidly mounted IMUs (rockets/piccard.csv). All three gyros saturate during a spin. The reference is the rate from the
differences of the accelerometers, which do not saturate.
"""
from __future__ import annotations

import csv
import json
import pathlib
from dataclasses import dataclass

import numpy as np

from .page import Table, number
from .runs import Runs

GRAVITY_M_S2 = 9.80665
FAST_RAD_S = np.deg2rad(150.0)  # slower samples do not determine the positions of the IMUs
INTERVAL_S = (60.25, 67.18)  # time in which the gyro is saturated
CLIPPED_RAD_S = 34.8  # smallest saturated reading
METHODS = (("raw", "raw", ()), ("interpolate", "interpolate", ()), ("saave", "saave", ()), ("tumble, whole recording", "tumble", ()),
           ("tumble, lag 0.2 s", "tumble_lag", ()), ("tumble, lag 0.02 s", "tumble_lag", ("tumble_lag.lag_s=0.02",)))


@dataclass
class Imu:
    """Readings of one IMU: time [s], rate [rad/s], specific force [m/s^2]."""

    time_s: np.ndarray
    rate_rad_s: np.ndarray
    force_m_s2: np.ndarray


@dataclass
class Reference:
    """The rate about x from the accelerometers.

    used       (N,) true for the saturated samples at which both baselines give a rate beyond the saturation limit
    rate       (N,) rate about x without sign, from the longer baseline [rad/s]
    sigma      standard deviation of `rate` at the used samples, from the disagreement of both baselines [rad/s]
    positions  positions of the second and third IMU relative to the first one [m]
    """

    time_s: np.ndarray
    used: np.ndarray
    rate: np.ndarray
    sigma: float
    positions: list[np.ndarray]


def read_imus(path: pathlib.Path) -> dict[str, Imu]:
    rows: dict[str, list[list[float]]] = {}
    with path.open(newline="") as file:
        for row in csv.DictReader(file):
            rows.setdefault(row["id"], []).append([float(row[name]) for name in ("ts", "Gx", "Gy", "Gz", "Ax", "Ay", "Az")])
    return {name: Imu(values[:, 0], np.deg2rad(values[:, 1:4]), GRAVITY_M_S2 * values[:, 4:]) for name, values in
            ((name, np.array(values)) for name, values in rows.items())}


def cross_matrices(vectors: np.ndarray) -> np.ndarray:
    x, y, z = vectors.T
    zero = np.zeros_like(x)
    return np.stack([np.stack([zero, -z, y], 1), np.stack([z, zero, -x], 1), np.stack([-y, x, zero], 1)], 1)


def position(first: Imu, second: Imu) -> np.ndarray:
    """Returns the position of the second IMU relative to the first one, by least squares over the fast unsaturated samples.

    The unknowns are the position and the difference of the accelerometers' biases. Four rounds leave out samples beyond three standard deviations.
    """
    w = cross_matrices(first.rate_rad_s)
    rows = cross_matrices(np.gradient(first.rate_rad_s, first.time_s, axis=0)) + w @ w
    used = (np.linalg.norm(first.rate_rad_s, axis=1) > FAST_RAD_S) & (np.abs(first.rate_rad_s).max(axis=1) < CLIPPED_RAD_S)
    rows = np.concatenate([rows, np.broadcast_to(np.eye(3), rows.shape)], axis=2)
    difference = second.force_m_s2 - first.force_m_s2
    for _ in range(4):
        solution = np.linalg.lstsq(rows[used].reshape(-1, 6), difference[used].reshape(-1), rcond=None)[0]
        squared = np.sum((difference - rows @ solution) ** 2, axis=1)
        used = used & (squared < 9.0 * np.mean(squared[used]))
    return solution[:3]


def rate_of_baseline(first: Imu, second: Imu, place: np.ndarray) -> np.ndarray:
    """Returns |w_x| from the difference of two accelerometers on a baseline along y: w_x^2 = -difference_y / y - w_z^2."""
    squared = -(second.force_m_s2 - first.force_m_s2)[:, 1] / place[1] - first.rate_rad_s[:, 2] ** 2
    return np.sqrt(np.maximum(squared, 0.0))


def reference(imus: dict[str, Imu]) -> Reference:
    first, *others = imus.values()
    positions = [position(first, other) for other in others]
    rates = [rate_of_baseline(first, other, place) for other, place in zip(others, positions)]
    saturated = (first.time_s >= INTERVAL_S[0]) & (first.time_s <= INTERVAL_S[1]) & (np.abs(first.rate_rad_s[:, 0]) > CLIPPED_RAD_S)
    used = saturated & (rates[1] > CLIPPED_RAD_S)
    # An error of the common accelerometer affects the shorter baseline more by the ratio of the lengths. With independent errors of equal size at each
    # accelerometer, the variance of the difference is that of the long baseline times 1 + ratio^2 - ratio.
    ratio = positions[1][1] / positions[0][1]
    spread = 1.4826 * np.median(np.abs(rates[1] - rates[0])[used])
    return Reference(first.time_s, used, rates[1], spread / np.sqrt(1.0 + ratio**2 - ratio), positions)


def read_rates(folder: pathlib.Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns times [s] of an estimate in the clock of the source, rates about x, and their standard deviations."""
    origin_s = 1e-9 * json.loads((folder / "estimate.json").read_text())["origin_ns"]
    with (folder / "rates.csv").open(newline="") as file:
        rows = [(1e-9 * int(row["time_ns"]), float(row["wx_rad_s"]), float(row["cxx"])) for row in csv.DictReader(file)]
    time_s, rate, variance = np.array(rows).T
    return time_s + origin_s, rate, np.sqrt(variance)


def scores(folder: pathlib.Path, truth: Reference) -> list[str]:
    """Returns the cells of one method: number of samples, median and 90th percentile of the error, stated deviation, share within three deviations."""
    time_s, rate, sigma = read_rates(folder)
    nearest = np.clip(np.searchsorted(time_s, truth.time_s - 1e-3), 0, len(time_s) - 1)
    used = truth.used & (np.abs(time_s[nearest] - truth.time_s) < 2e-3)
    error = np.abs(np.abs(rate[nearest]) - truth.rate)[used]
    stated = sigma[nearest][used]
    within = np.mean(error < 3.0 * np.hypot(stated, truth.sigma))
    return [str(int(used.sum())), number(float(np.median(error))), number(float(np.quantile(error, 0.9))), number(float(np.median(stated))),
            f"{100.0 * within:.1f} %"]


def reproduce(runs: Runs, data: pathlib.Path) -> str:
    """Runs the methods on the recording and returns the page."""
    source = data / "rockets" / "piccard.csv"
    imus = read_imus(source)
    truth = reference(imus)
    first = runs.folder / "imu0.csv"
    runs.folder.mkdir(parents=True, exist_ok=True)
    lines = source.read_text().splitlines()
    first.write_text("\n".join([lines[0], *(line for line in lines[1:] if line.split(",")[2] == "IMU0")]) + "\n")
    table = Table(["IMUs", "method", "samples", "median [rad/s]", "90 % [rad/s]", "stated deviation [rad/s]", "within three deviations"])
    for title, file in (("one", first), ("three", source)):
        recording = runs.folder / f"{title}.h5"
        runs.call("import", file, "--gyro-unit", "deg/s", "--accel-unit", "g", "-o", recording)
        for name, method, settings in METHODS:
            folder = runs.estimate(recording, f"rate/{method}", runs.folder / title / name.replace(" ", "_").replace(",", ""), settings)
            table.add(title, name, *scores(folder, truth))
    places = "; ".join("(" + ", ".join(f"{1e3 * value:.2f}" for value in place) + ") mm" for place in truth.positions)
    used = truth.rate[truth.used]
    return (f"# Saturated gyros with a reference\n\n"
            f"The rocket spins about x for {INTERVAL_S[1] - INTERVAL_S[0]:.1f} s beyond the saturation limit of its gyros. The table shows the error of "
            f"the rate about x without sign.\n\n{table.text()}\n"
            f"The reference comes from the differences of the three accelerometers. The second and third IMU are at {places} from the first IMU. "
            f"The reference rate has the median {np.median(used):.1f} rad/s and the standard deviation {truth.sigma:.2f} rad/s. "
            f"The share within three deviations includes the deviation of the reference.\n")
