# SPDX-License-Identifier: BSD-3-Clause
"""Runs odometry with the interface of KISS-ICP, which takes one sweep per call with the time of each return."""
import numpy as np

from poses import Track
from recording import Recording


def followed(odometry, sensors: Recording) -> Track:
    """Returns the poses of the lidar from `register_frame(points, seconds)` and `last_pose`. Each sweep is deskewed to
    its last point, so this point's time is the time of the pose."""
    track = Track([], [], "lidar")
    for sweep in sensors.sweeps:
        odometry.register_frame(sweep.points_L_m, sweep.offset_ns * 1e-9)
        track.time_ns.append(sweep.start_ns + int(sweep.offset_ns.max()))
        track.T_WA.append(np.array(odometry.last_pose))
    return track
