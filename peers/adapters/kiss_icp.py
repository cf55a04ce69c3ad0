# SPDX-License-Identifier: BSD-3-Clause
"""KISS-ICP (Vizzo et al., RA-L 2023), PyPI kiss-icp. Uses only the lidar.

Settings are the package's defaults: max_range 100 m, deskewing, adaptive threshold, and a voxel size of max_range / 100
as in its load_config. A sweep is deskewed to its last point, and the pose belongs to this time (cpp
Preprocessing.cpp)."""
from kiss_icp.config import KISSConfig
from kiss_icp.kiss_icp import KissICP

from frames import followed
from poses import Track
from recording import Recording


def run(sensors: Recording) -> Track:
    config = KISSConfig()
    config.mapping.voxel_size = config.data.max_range / 100.0
    return followed(KissICP(config), sensors)
