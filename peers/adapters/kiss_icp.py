# SPDX-License-Identifier: BSD-3-Clause
"""KISS-ICP (Vizzo et al., RA-L 2023), PyPI kiss-icp. Lidar alone.

Settings: the package's defaults (max_range 100 m, deskewing, threshold adaptive), with max_range / 100 as voxel as
its load_config takes it. A sweep is deskewed to its last point, whose pose it gives (cpp Preprocessing.cpp)."""
from kiss_icp.config import KISSConfig
from kiss_icp.kiss_icp import KissICP

from frames import followed
from poses import Track
from recording import Recording


def run(sensors: Recording) -> Track:
    config = KISSConfig()
    config.mapping.voxel_size = config.data.max_range / 100.0
    return followed(KissICP(config), sensors)
