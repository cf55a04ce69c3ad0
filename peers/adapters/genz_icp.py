# SPDX-License-Identifier: BSD-3-Clause
"""GenZ-ICP (Lee et al., RA-L 2025), PyPI genz-icp. Uses only the lidar.

Settings are the authors' tuned files in the package: `indoor` for a room, `outdoor` for a hill. Deskewing is on,
because points have times."""
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
