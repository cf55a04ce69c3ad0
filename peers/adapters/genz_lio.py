# SPDX-License-Identifier: BSD-3-Clause
"""GenZ-LIO (PyPI genz-lio, GPL-2: an installed program, from which no code is copied). Uses lidar and IMU.

Settings are the authors' default/robosense.yaml for 16 rings at 10 Hz, with the rig's extrinsics. The poses are those
of the IMU."""
import pathlib

import genz_lio
import numpy as np
from genz_lio.config import load_config
from genz_lio.genz_lio_pybind import GenZLIO

from poses import Track
from recording import Recording


def run(sensors: Recording) -> Track:
    config = load_config(pathlib.Path(genz_lio.__file__).parent / "configs/default/robosense.yaml")
    config.mapping.extrinsic_t = sensors.T_IL[:3, 3]
    config.mapping.extrinsic_r = sensors.T_IL[:3, :3]
    odometry = GenZLIO(config)
    rows = np.column_stack([sensors.time_ns * 1e-9, sensors.accel_I_m_s2, sensors.gyro_I_rad_s])
    track, fed = Track([], [], "imu"), 0
    for sweep in sensors.sweeps:
        upto = sensors.until(sweep.end_ns, fed)
        if upto == fed:
            continue
        result = odometry.register_scan(sweep.points_L_m, sweep.start_ns * 1e-9, sweep.end_ns * 1e-9, rows[fed:upto],
                                        timestamps=sweep.offset_ns * 1e-9)
        fed = upto
        if result.valid:
            track.time_ns.append(int(round(result.timestamp * 1e9)))
            track.T_WA.append(np.array(result.pose))
    return track
