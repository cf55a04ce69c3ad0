#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests the warnings of `tumble import` for a recording with a wrong gyro, mounting or clock.

    import_variants.py PROGRAM RECORDING.h5

The script writes the recording as MCAP with one change at a time: signs and order of the gyro axes, gyro unit, lidar
mounting or lidar clock. It imports each file, and prints the sentence that compares the gyro with the lidar, or
"nothing said". Needs the package `tumble` and numpy. The numbers in the changelog are from `stroll`, seeds 98001 and
98002.
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import tumble

FLIPS = {"(-x, y, z)": [-1, 2, 3], "(x, y, -z)": [1, 2, -3], "(-x, -y, -z)": [-1, -2, -3], "(y, x, z)": [2, 1, 3],
         "(y, z, x)": [2, 3, 1]}
DELAYS_S = (-0.3, -0.2, -0.1, -0.06, 0.06, 0.1, 0.2, 0.4)
MOUNTINGS_DEG = (10, 40, 90)


def axes(order):
    def change(recording):
        imu = recording.imus[0]
        gyro = np.asarray(imu.gyro)
        imu.gyro = np.stack([np.sign(k) * gyro[:, abs(k) - 1] for k in order], axis=1)
    return change


def degrees(recording):
    imu = recording.imus[0]
    imu.gyro = np.rad2deg(np.asarray(imu.gyro))
    imu.gyro_range_rad_s = 0.0


def mounting(degrees_about_y):
    c, s = np.cos(np.deg2rad(degrees_about_y)), np.sin(np.deg2rad(degrees_about_y))

    def change(recording):
        T_BL = np.array(recording.lidars[0].T_BL)
        T_BL[:3, :3] = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]) @ T_BL[:3, :3]
        recording.lidars[0].T_BL = T_BL
    return change


def delay(seconds):
    def change(recording):
        lidar = recording.lidars[0]
        lidar.sweep_start_ns = np.asarray(lidar.sweep_start_ns) + round(1e9 * seconds)
    return change


def variants():
    yield "as it is", lambda recording: None
    for name, order in FLIPS.items():
        yield "gyro " + name, axes(order)
    yield "gyro in deg/s", degrees
    for angle in MOUNTINGS_DEG:
        yield f"lidar turned by {angle} deg", mounting(angle)
    for seconds in DELAYS_S:
        yield f"lidar's clock {seconds:+g} s", delay(seconds)


def said(program, recording, folder):
    changed, bag, back = folder / "changed.h5", folder / "changed.mcap", folder / "back.h5"
    for path in (changed, bag, back):
        path.unlink(missing_ok=True)
    tumble.write(changed, recording, truth=False)
    subprocess.run([program, "export", changed, "-o", bag], check=True, capture_output=True)
    done = subprocess.run([program, "import", bag, "-o", back, "--imu-topic", "/imu"], capture_output=True, text=True)
    lines = [line for line in (done.stdout + done.stderr).splitlines() if "the lidar " in line]
    return lines[0] if lines else "nothing said"


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as folder:
        for name, change in variants():
            recording = tumble.read(sys.argv[2])
            change(recording)
            print(f"{name}: {said(sys.argv[1], recording, pathlib.Path(folder))}", flush=True)


if __name__ == "__main__":
    main()
