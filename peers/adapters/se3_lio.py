# SPDX-License-Identifier: BSD-3-Clause
"""SE(3)-LIO (ICRA 2026), PyPI se3-lio. Uses lidar and IMU.

Settings are the package's defaults (SE3LIOConfig). Inputs are the lidar's pose in IMU axes, and each sweep with the IMU
samples within its duration. The poses are those of the IMU, with the package's own time stamps."""
import numpy as np
from se3_lio.config import SE3LIOConfig
from se3_lio.se3_lio import SE3LIO

from poses import Track
from recording import Recording


def run(sensors: Recording) -> Track:
    odometry = SE3LIO(SE3LIOConfig(), sensors.T_IL)
    rows = np.column_stack([sensors.time_ns * 1e-9, sensors.accel_I_m_s2, sensors.gyro_I_rad_s])
    track, fed = Track([], [], "imu"), 0
    for sweep in sensors.sweeps:
        upto = sensors.until(sweep.end_ns, fed)
        if upto == fed:
            continue
        order = np.argsort(sweep.offset_ns, kind="stable")
        state, _ = odometry.register_frame(sweep.points_L_m[order], sweep.offset_ns[order] * 1e-9, rows[fed:upto], sweep.start_ns * 1e-9)
        fed = upto
        track.time_ns.append(int(round(state.stamp * 1e9)))
        track.T_WA.append(np.array(state.pose))
    return track
