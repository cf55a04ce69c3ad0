# SPDX-License-Identifier: BSD-3-Clause
"""GenZ-ICP (Lee et al., RA-L 2025), PyPI genz-icp. Lidar alone.

Settings: the authors' pretuned file for `indoor` (of a room) or `outdoor` (of a hill), packaged with it; deskewing on, since points
have times."""
import pathlib

import numpy as np
from genz_icp.config import load_config
from genz_icp.genz_icp import GenZICP

from poses import Track
from recording import Recording


def run(sensors: Recording, pretuned: str = "indoor") -> Track:
    config = load_config(pathlib.Path(pretuned))
    config.data.deskew = True
    odometry = GenZICP(config)
    track = Track([], [], "lidar")
    for sweep in sensors.sweeps:
        odometry.register_frame(sweep.points_L_m, sweep.offset_ns * 1e-9)
        track.time_ns.append(sweep.start_ns + int(sweep.offset_ns.max()))
        track.T_WA.append(np.array(odometry.last_pose))
    return track
