# SPDX-License-Identifier: BSD-3-Clause
"""GenZ-ICP (Lee et al., RA-L 2025), PyPI genz-icp. Lidar alone.

Settings: the authors' pretuned file for `indoor` (of a room) or `outdoor` (of a hill), packaged with it; deskewing on, since points
have times."""
import pathlib

from genz_icp.config import load_config
from genz_icp.genz_icp import GenZICP

from frames import followed
from poses import Track
from recording import Recording


def run(sensors: Recording, pretuned: str = "indoor") -> Track:
    config = load_config(pathlib.Path(pretuned))
    config.data.deskew = True
    return followed(GenZICP(config), sensors)
