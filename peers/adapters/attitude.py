# SPDX-License-Identifier: BSD-3-Clause
"""Attitude filters for gyro and accelerometer: vqf (Laidig, Seel 2023), ahrs (Madgwick, Mahony, extended Kalman
filter), imufusion (x-io).

Each package has its default settings, and the rate of the IMU. The Kalman filter uses the frame "NED", in which the
specific force at rest points along z; in its "ENU", the specific force points against z. The filters of ahrs start at
the attitude from gravity. The other filters start as their packages do; imufusion has a high gain in its first 3 s.
Attitudes are those of the IMU, W with z up."""
import numpy as np

from poses import Track, quaternion_xyzw, turning, up_in
from recording import Recording


def rotations(q_wxyz: np.ndarray) -> list:
    """Converts Hamilton quaternions to rotation matrices, body to world."""
    w, x, y, z = (q_wxyz / np.linalg.norm(q_wxyz, axis=1, keepdims=True)).T
    R = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                  [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                  [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    return list(R.transpose(2, 0, 1))


def vqf(sensors: Recording, seconds: float) -> np.ndarray:
    import vqf as package
    return package.VQF(seconds).updateBatch(np.ascontiguousarray(sensors.gyro_I_rad_s), np.ascontiguousarray(sensors.accel_I_m_s2))["quat6D"]


def ahrs(sensors: Recording, seconds: float, name: str) -> np.ndarray:
    from ahrs import filters
    x, y, z, w = quaternion_xyzw(turning(up_in("imu", sensors), np.array([0.0, 0.0, 1.0])))
    return getattr(filters, name)(gyr=sensors.gyro_I_rad_s, acc=sensors.accel_I_m_s2, frequency=1.0 / seconds, q0=[w, x, y, z]).Q


def madgwick(sensors: Recording, seconds: float) -> np.ndarray:
    return ahrs(sensors, seconds, "Madgwick")


def mahony(sensors: Recording, seconds: float) -> np.ndarray:
    return ahrs(sensors, seconds, "Mahony")


def ekf(sensors: Recording, seconds: float) -> np.ndarray:
    return ahrs(sensors, seconds, "EKF")


def imufusion(sensors: Recording, seconds: float) -> np.ndarray:
    import imufusion as package
    filter_ = package.Ahrs()
    filter_.set_sample_period(seconds)
    out = []
    for gyro, accel in zip(np.degrees(sensors.gyro_I_rad_s), sensors.accel_I_m_s2 / 9.80665):
        filter_.update_no_magnetometer(gyro, accel)
        out.append(filter_.get_quaternion())
    return np.array(out)


def run(sensors: Recording, name: str) -> Track:
    q_wxyz = {"vqf": vqf, "madgwick": madgwick, "mahony": mahony, "ekf": ekf, "imufusion": imufusion}[name](sensors, sensors.period_ns * 1e-9)
    T_WI = []
    for R in rotations(np.asarray(q_wxyz, float)):
        T = np.eye(4)
        T[:3, :3] = R
        T_WI.append(T)
    return Track(list(sensors.time_ns), T_WI, "imu")
