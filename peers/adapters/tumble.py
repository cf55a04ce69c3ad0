# SPDX-License-Identifier: BSD-3-Clause
"""TumblingOdometry of this project, for `tools/peers time`. Uses lidar and IMU.

Settings are the defaults with the sensors of the recording, and the additional PARAMETER=NUMBER of the call. The poses
are the live poses at the end of a sweep. Prints the mean number of points that a sweep registers."""
import numpy as np
import tumble

from poses import Track
from recording import OWN_BODY_L_M, Recording


def run(sensors: Recording, *settings: str) -> Track:
    sheet = tumble.ImuDataSheet(gyro_range_rad_s=sensors.gyro_range_rad_s, accel_range_m_s2=sensors.accel_range_m_s2,
                                rate_hz=1e9 / sensors.period_ns, gyro_noise_rad_s_sqrt_hz=sensors.gyro_noise_rad_s_sqrt_hz,
                                accel_noise_m_s2_sqrt_hz=sensors.accel_noise_m_s2_sqrt_hz)
    odometry = tumble.TumblingOdometry(imu=sheet, lever_arm_m=sensors.lever_arm_I_m, T_IL=sensors.T_IL, own_body_L=OWN_BODY_L_M,
                                       gravity_m_s2=sensors.gravity_m_s2,
                                       **{name: float(number) for name, number in (setting.split("=") for setting in settings)})
    track, fed, registered = Track([], [], "imu"), 0, []
    for sweep in sensors.sweeps:
        upto = sensors.until(sweep.end_ns, fed)
        odometry.add_imu(sensors.time_ns[fed:upto], sensors.gyro_I_rad_s[fed:upto], sensors.accel_I_m_s2[fed:upto])
        fed = upto
        odometry.add_sweep(sweep.start_ns, sweep.end_ns, sweep.points_L_m, sweep.offset_ns, sweep.ring)
        registered += [done.result.points_after_downsampling for done in odometry.take_all() if done.placed]
        if not registered:
            continue  # the map has not started
        pose = odometry.newest()
        track.time_ns.append(int(pose.time_ns))
        track.T_WA.append(np.array(pose.matrix))
    print(f"registers {np.mean(registered):.0f} points per sweep")
    return track
