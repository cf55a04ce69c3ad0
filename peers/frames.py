# SPDX-License-Identifier: BSD-3-Clause
"""Odometry that is given a sweep at a time with the time of each return, as KISS-ICP takes it and what was made after it."""
import numpy as np

from poses import Track
from recording import Recording


def followed(odometry, sensors: Recording) -> Track:
    """Poses of the lidar by `register_frame(points, seconds)` and `last_pose`, each at its sweep's last point, which the sweep
    is deskewed to."""
    track = Track([], [], "lidar")
    for sweep in sensors.sweeps:
        odometry.register_frame(sweep.points_L_m, sweep.offset_ns * 1e-9)
        track.time_ns.append(sweep.start_ns + int(sweep.offset_ns.max()))
        track.T_WA.append(np.array(odometry.last_pose))
    return track
