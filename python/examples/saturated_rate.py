# SPDX-License-Identifier: BSD-3-Clause
"""Estimates angular velocity through gyro saturation: saturated_rate.py [RepoIMU.csv]

A hand-held wand rotates faster than the range of its gyro. With a file of RepoIMU (github.com/agnieszkaszczesna/RepoIMU, TStick), the
program compares the rotation speed with a camera system. Without a file, it uses a simulated twirl that clips at 7.3 rad/s.
"""
import sys

import numpy as np

import tumble


def wand(path):
    """Returns the IMU samples and the rotation speed of the cameras, from pairs of attitudes 40 ms apart."""
    rows = np.loadtxt(path, delimiter=";", skiprows=2, usecols=range(11))
    t, q = rows[:, 0], rows[:, 1:5]
    imu = tumble.Imu(np.round(1e9 * (t - t[0])).astype(np.int64), rows[:, 8:11], rows[:, 5:8])
    speed = np.full(len(t), np.nan)
    for k in range(2, len(t) - 2):
        cosine = abs(q[k - 2] @ q[k + 2]) / np.linalg.norm(q[k - 2]) / np.linalg.norm(q[k + 2])
        speed[k] = 2 * np.arccos(min(1.0, cosine)) / (t[k + 2] - t[k - 2])
    return imu, speed


def twirl(seconds=12.0, rate_hz=100.0, rail=7.3):
    """Simulates a hand-held body that oscillates about a horizontal axis at up to 10 rad/s, and its rotation speed."""
    time_ns = (np.arange(1, round(seconds * rate_hz) + 1) * 1e9 / rate_hz).astype(np.int64)
    t = np.maximum(time_ns * 1e-9 - 2.0, 0.0)  # the body is stationary for the first two seconds
    w, angle = 10.0 * np.sin(np.pi * t), 10.0 / np.pi * (1.0 - np.cos(np.pi * t))
    noise = np.random.default_rng(1)
    gyro = np.stack([w, 0 * w, 0 * w], axis=1) + noise.normal(0, 5e-3, (len(t), 3))
    force = 9.80665 * np.stack([0 * w, np.sin(angle), np.cos(angle)], axis=1) + noise.normal(0, 0.05, (len(t), 3))
    return tumble.Imu(time_ns, np.clip(gyro, -rail, rail), force), np.abs(w)


imu, speed = wand(sys.argv[1]) if len(sys.argv) > 1 else twirl()
rates = tumble.rate(imu, lever_arm_sigma_m=0.1)  # the centre of mass of the wand is unknown

rails = tumble.find_rails(*imu.samples)
print("rails found, rad/s:", [None if plane is None else round(plane.distance, 2) for plane in rails.gyro])
clipped = (rates.clipped_axes != 0) & np.isfinite(speed)
for name, rate in (("gyro", imu.gyro), ("tumble", rates.rate)):
    error = np.abs(np.linalg.norm(rate, axis=1) - speed)[clipped]
    print(f"{name:6} at {clipped.sum()} clipped samples: median error of the speed {np.median(error):.2f} rad/s, 90 % {np.quantile(error, 0.9):.2f}")
sigma = np.sqrt(rates.covariance[:, 0, 0])
print(f"estimated standard deviation of x, rad/s: {np.median(sigma[~clipped]):.4f} unclipped, {np.median(sigma[clipped]):.2f} clipped")
