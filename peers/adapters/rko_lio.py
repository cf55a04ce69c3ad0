# SPDX-License-Identifier: BSD-3-Clause
"""RKO-LIO (Malladi et al., RA-L 2026), PyPI rko-lio. Uses lidar and IMU.

Settings are the package's defaults with the initialisation phase, which levels the world and estimates the gyro bias at
rest. The documentation recommends this phase for robots that start at rest. The poses are those of the base, here the
IMU, at the last point of a sweep."""
import numpy as np
from rko_lio.config import LIOConfig
from rko_lio.lio import LIO

from poses import Track
from recording import Recording


def run(sensors: Recording) -> Track:
    odometry = LIO(LIOConfig(initialization_phase=True))
    track, fed = Track([], [], "imu"), 0
    for sweep in sensors.sweeps:
        upto = sensors.until(sweep.end_ns, fed)
        for k in range(fed, upto):
            odometry.add_imu_measurement(sensors.accel_I_m_s2[k], sensors.gyro_I_rad_s[k], int(sensors.time_ns[k]), np.eye(4))
        fed = upto
        try:
            odometry.register_scan(sweep.points_L_m, sweep.start_ns + sweep.offset_ns, sensors.T_IL)
        except Exception as error:  # the package skips such a sweep, too
            print(f"sweep at {sweep.start_ns} ns dropped: {error}")
            continue
        track.time_ns.append(sweep.start_ns + int(sweep.offset_ns.max()))
        track.T_WA.append(np.array(odometry.pose()))
    return track
