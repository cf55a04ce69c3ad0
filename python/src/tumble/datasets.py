# SPDX-License-Identifier: BSD-3-Clause
"""Reads recordings of the public data sets BROAD, RepoIMU and AirbrakesV2. `tumble.write` stores the result for the program."""
from __future__ import annotations

import csv
import os
import pathlib
from typing import Any

import numpy as np
import numpy.typing as npt

from . import optical
from .checks import path_of
from .errors import TumbleError
from .files import optional
from .hdf5 import Group
from .recordings import Imu, Recording
from .truth import ImuTruth, Truth

Array = npt.NDArray[Any]


def _imu(time_ns: Array, gyro: Array, accel: Array, **others: Any) -> Imu:
    return Imu(time_ns=time_ns - time_ns[0], gyro=gyro, accel=accel, period_ns=int(optical.upper_median(np.diff(time_ns))), **others)


def read_broad(path: str | os.PathLike[str]) -> Recording:
    """Reads a trial of BROAD (HDF5), with the optical reference as truth if the file contains one.

    The body axes are the IMU axes; the world axes are east, north, up. The truth is unknown (NaN) where the cameras lost the markers. Its
    velocities and rates are differences over 140 ms, and its rates at the IMU samples are derivatives over 40 ms (`optical.rates`).
    """
    name = path_of("path", path)
    with optional("h5py", "files").File(name, "r") as file:
        group = Group(file, name)
        rate_hz = group.attribute("sampling_rate", float)
        gyro, accel = group.rows("imu_gyr", "f8", (3,)), group.rows("imu_acc", "f8", (3,))
        field = group.rows("imu_mag", "f8", (3,), optional=True)
        position, wxyz = group.rows("opt_pos", "f8", (3,), optional=True), group.rows("opt_quat", "f8", (4,), optional=True)
    time_ns = optical.nearest(np.arange(len(gyro)) * 1e9 / rate_hz)  # multiples of a rounded period would drift
    imu = Imu(time_ns, gyro, accel, period_ns=int(optical.nearest(1e9 / rate_hz)), magnetic_field_t=None if field is None else 1e-6 * field)
    truth = None
    if position is not None and wxyz is not None:
        norm = np.linalg.norm(wxyz, axis=1)
        if (np.abs(norm - 1.0) > 1e-2).any():
            raise TumbleError(f"{name}: /opt_quat must have rows of norm 1", "file", f"{name}: /opt_quat", float(np.nanmax(norm)), 1.0)
        q = (wxyz / norm[:, None])[:, [1, 2, 3, 0]]
        known = np.isfinite(norm)
        velocity, rate = optical.differences(imu.period_ns, position, q, 20)
        truth = Truth(imu.period_ns, position, q, velocity, rate, imus=[ImuTruth("imu", rate=optical.rates(time_ns[known], q[known], time_ns))])
    return Recording([imu], truth=truth, attribution=(
        "D. Laidig, M. Caruso, A. Cereatti, T. Seel: BROAD - A Benchmark for Robust Inertial Orientation Estimation, Data 2021, 6(7), 72; "
        f"CC BY 4.0; trial {pathlib.Path(name).stem}"))


def read_airbrakes(path: str | os.PathLike[str]) -> Recording:
    """Reads a flight log of AirbrakesV2 (CSV): the longest part without a gap above 1 s. Rows that repeat a stamp are dropped."""
    name = path_of("path", path)
    with open(name, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))

    def columns(*names: str) -> Array:
        missing = [each for each in names if each not in rows[0]]
        if missing:
            raise TumbleError(f"{name} has no column {missing[0]}", "file", missing[0])
        at = [rows[0].index(each) for each in names]
        return np.array([[float(row[k]) for k in at] for row in rows[1:]])

    time_ns = optical.nearest(1e9 * columns("timestamp_seconds")[:, 0])
    fresh = np.flatnonzero(np.diff(time_ns, prepend=time_ns[0] - 1) != 0)
    ends = [0, *(np.flatnonzero(np.diff(time_ns[fresh]) > 1_000_000_000) + 1), len(fresh)]
    longest = int(np.argmax(np.diff(ends)))
    kept = fresh[ends[longest]:ends[longest + 1]]
    gyro = columns(*(f"raw_angular_rate_{axis}_deg_per_s" for axis in "xyz"))[kept] * (1.0 / 57.29577951308232)
    accel = columns(*(f"raw_acceleration_{axis}_gs" for axis in "xyz"))[kept] * 9.80665
    field = [f"magnetic_field_{axis}_microteslas" for axis in "xyz"]
    magnetic = 1e-6 * columns(*field)[kept] if field[0] in rows[0] else None
    return Recording([_imu(time_ns[kept], gyro, accel, magnetic_field_t=magnetic)], origin_ns=int(time_ns[kept[0]]), attribution=(
        "AirbrakesV2, NCSU High-Powered Rocketry Club (github.com/NCSU-High-Powered-Rocketry-Club/AirbrakesV2), MIT; "
        f"{pathlib.Path(name).name}"))


def read_repoimu(path: str | os.PathLike[str]) -> Recording:
    """Reads a recording of RepoIMU (CSV), with the attitudes of the cameras as truth, aligned with the IMU in time, rotation and vertical.

    Corrections: rounded time stamps become regular; repeated readings (sample and hold) are dropped, and a slower accelerometer is
    interpolated; glitches of the cameras are removed (`optical.without_glitches`). The magnetometer is left out, because it has no unit.
    """
    name = path_of("path", path)
    text = pathlib.Path(name).read_text(encoding="utf-8").replace(",", ".")  # one published file has a decimal comma
    lines = [line.split(";") for line in text.splitlines()]
    if lines[0][1] != "Vicon Orientation" or lines[1][1:5] != list("WXYZ"):
        raise TumbleError(f"{name} is not a file of RepoIMU; the second column must be 'Vicon Orientation'", "file", name)
    table = np.array([[float(number or "nan") for number in line[:11]] for line in lines[2:]])
    stamps = optical.nearest(table[:, 0] * 1e9)
    decimals = [len(line[0].partition(".")[2]) for line in lines[2:]]
    half = np.array([optical.nearest(0.5e9 * 10.0 ** -max(decimals[max(0, k - 50):k + 51])) for k in range(len(decimals))])
    time_ns = optical.steady_stamps(stamps - stamps[0], half, half)
    origin_ns = int(stamps[0] + time_ns[0])
    time_ns -= time_ns[0]
    log_ns, gyro, accel = time_ns, table[:, 8:11], table[:, 5:8]
    gyro_rows, accel_rows = _fresh(gyro), _fresh(accel)
    if _repeats(gyro_rows, len(gyro)):
        time_ns, gyro = _beat(log_ns, gyro_rows), gyro[gyro_rows]
    beside = accel[gyro_rows] if len(gyro) < len(accel) else accel
    accel = optical.interpolated(_beat(log_ns, accel_rows), accel[accel_rows], time_ns) if _repeats(_fresh(beside), len(beside)) else beside
    imu = _imu(time_ns, gyro, accel)
    imu.time_ns = time_ns
    pose_ns, q = optical.without_glitches(log_ns, table[:, [2, 3, 4, 1]])
    pose_ns, q = optical.aligned(pose_ns, q, imu)
    truth = optical.truth_of(pose_ns, q, int(time_ns[-1]))
    truth.imus = [ImuTruth("imu", rate=optical.rates(pose_ns, q, time_ns))]
    return Recording([imu], truth=truth, origin_ns=origin_ns, attribution=(
        "RepoIMU: A. Szczesna, P. Skurowski, P. Pruszowski, D. Peszor, M. Paszkuta, K. Wojciechowski: Reference Data Set for Accuracy "
        "Evaluation of Orientation Estimation Algorithms for Inertial Motion Capture Systems, ICCVG 2016; "
        f"{pathlib.Path(name).name}"))


def _fresh(readings: Array) -> Array:
    """Returns the rows whose reading differs from that of the previous row."""
    return np.flatnonzero(np.append(True, (np.diff(readings, axis=0) != 0.0).any(axis=1)))


def _repeats(fresh: Array, rows: int) -> bool:
    """Returns whether 5 to 98 % of the rows repeat the previous row. A sensor that repeats more often counts as frozen."""
    return 0.05 < (rows - len(fresh)) / max(rows - 1, 1) < 0.98


def _beat(time_ns: Array, rows: Array) -> Array:
    """Returns regular times for readings that arrived between the times of the previous row and of their row."""
    before = np.where(rows == 0, 0, time_ns[rows] - time_ns[rows - 1] - 1)
    return optical.steady_stamps(time_ns[rows], before, np.zeros_like(before))
