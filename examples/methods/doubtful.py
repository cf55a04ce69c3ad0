# SPDX-License-Identifier: BSD-3-Clause
"""A rate method in one function: returns the unchanged gyro readings, with a large variance for clipped readings.
Run it with `tumble run hill --seed 1 --method examples/methods/doubtful.py`, or with `tumble bench`. doubtful.c is the
same in C."""
import numpy as np

AT_RAIL = 0.98                         # of the largest reading of an axis
FREE_RAD_S, CLIPPED_RAD_S = 0.01, 5.0  # standard deviations


def rate(recording):
    gyro = recording.imus[0].gyro
    clipped = np.abs(gyro) >= AT_RAIL * np.abs(gyro).max(axis=0)
    sigma = np.where(clipped, CLIPPED_RAD_S, FREE_RAD_S)
    return gyro, sigma[:, :, None] ** 2 * np.eye(3)
