# SPDX-License-Identifier: BSD-3-Clause
"""KISS-ICP (Vizzo et al., RA-L 2023), PyPI kiss-icp. Lidar alone.

Settings: the package's defaults (max_range 100 m, deskewing, threshold adaptive), with max_range / 100 as voxel as
its load_config takes it. A sweep is deskewed to its last point, whose pose it gives (cpp Preprocessing.cpp)."""
import numpy as np
from kiss_icp.config import KISSConfig
from kiss_icp.kiss_icp import KissICP

from poses import Track
from recording import Recording


def run(sensors: Recording) -> Track:
    config = KISSConfig()
    config.mapping.voxel_size = config.data.max_range / 100.0
    odometry = KissICP(config)
    track = Track([], [], "lidar")
    for sweep in sensors.sweeps:
        odometry.register_frame(sweep.points_L_m, sweep.offset_ns * 1e-9)
        track.time_ns.append(sweep.start_ns + int(sweep.offset_ns.max()))
        track.T_WA.append(np.array(odometry.last_pose))
    return track
