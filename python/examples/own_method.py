# SPDX-License-Identifier: BSD-3-Clause
"""Compares your own rate method with others over several tumbles: own_method.py

This file is also the method: the program runs it with the paths of a recording and of the result.
"""
import sys

import numpy as np

import tumble


def rate(recording):
    """Estimates the most clipped axis from the specific force, which in flight is w x (w x lever arm)."""
    imu = recording.imus[0]
    rate, rail = imu.gyro.copy(), 0.98 * np.abs(imu.gyro).max(axis=0)
    for k in np.flatnonzero((np.abs(rate) >= rail).any(axis=1)):
        axis = np.argmax(np.abs(rate[k]) / rail)
        tried = np.repeat(rate[k][None], 60, axis=0)
        tried[:, axis] *= np.linspace(1.0, 3.0, 60)
        force = np.cross(tried, np.cross(tried, imu.lever_arm_m))
        rate[k] = tried[np.argmin(np.linalg.norm(force - imu.accel[k], axis=1))]
    return rate


if len(sys.argv) == 3:
    tumble.serve("rate", rate)
else:
    mine = tumble.describe_method("mine.yaml", "mine", "rate", __file__, doc="the clipped axis from the centripetal force")
    frame = tumble.sweep("bare", "mine.db", seeds=(1, 3), methods=["rate/raw", "rate/tumble", mine])
    errors = frame[frame.metric == "rate_error_clipped_median_rad_s"]
    print(errors.pivot(index="seed", columns="method", values="value").to_string(float_format="%.3f"))
