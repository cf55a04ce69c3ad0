# SPDX-License-Identifier: BSD-3-Clause
"""small_gicp (Koide, JOSS 2024), PyPI small_gicp. Uses only the lidar. The package is a registration library, so this
adapter follows the authors' scan-to-model example (kitti_odometry.py): it registers each sweep to a map of Gaussian
voxels, with a constant-motion start.

Settings are those of the example: voxels of 0.25 m for a sweep and 1 m for the map, 10 neighbours. Sweeps are not
deskewed."""
import numpy as np
import small_gicp

from poses import Track
from recording import Recording


def run(sensors: Recording) -> Track:
    voxels = small_gicp.GaussianVoxelMap(1.0)
    voxels.set_lru(horizon=100, clear_cycle=10)
    T_WL, change = np.eye(4), np.eye(4)
    track = Track([], [], "lidar")
    for sweep in sensors.sweeps:
        cloud, _ = small_gicp.preprocess_points(sweep.points_L_m, 0.25, num_neighbors=10, num_threads=1)
        if track.time_ns:
            result = small_gicp.align(voxels, cloud, init_T_target_source=T_WL @ change, max_correspondence_distance=1.0,
                                      num_threads=1)
            change = np.linalg.inv(T_WL) @ result.T_target_source
            T_WL = np.array(result.T_target_source)
        voxels.insert(cloud, T_WL)
        # the sweep is not deskewed, so its pose belongs to its middle
        track.time_ns.append(sweep.start_ns + (sweep.end_ns - sweep.start_ns) // 2)
        track.T_WA.append(T_WL.copy())
    return track
