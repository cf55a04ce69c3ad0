# SPDX-License-Identifier: BSD-3-Clause
"""Estimates poses and map of a tumbling rig: map_of_a_tumble.py [RECORDING.h5]

Without an argument, the program simulates a recording: a rig with a lidar that falls down a hill.
"""
import pathlib
import sys

import numpy as np

import tumble

path = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else tumble.record("hill", "hill.h5", seed=1)
recording = tumble.read(path)
print(f"{recording.scenario}: {len(recording.imus[0])} readings of {recording.imus[0].device}, {len(recording.sweeps)} sweeps")

tumbled = tumble.tumbling(recording)  # data in the order of a live robot; TumblingOdometry is the live interface
length_m = np.linalg.norm(np.diff(tumbled.poses.position, axis=0), axis=1).sum()
names = [sweep.verdict.name for sweep in tumbled.sweeps]
print(f"{len(tumbled.poses)} poses over {length_m:.1f} m; sweeps:", {name: names.count(name) for name in sorted(set(names))})
print(f"a map of {len(tumbled.map)} points; estimated lever arm, m: {np.round(tumbled.odometry.body_imu_calibration().lever_arm_m, 4)}")

tumble.write_tum("tumble.tum", tumbled.poses)
sharp = tumbled.map.sigma < 0.05
np.savetxt("map.xyz", tumbled.map.position[sharp], fmt="%.3f")
if recording.truth is not None:
    scores = tumble.score("tumble.tum", path, kind="slam")
    print(f"against the truth: ate {scores['ate_m']:.3f} m, at the end {scores['translation_error_end_m']:.3f} m")
