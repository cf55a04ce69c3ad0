# SPDX-License-Identifier: BSD-3-Clause
"""Pelorus (University of Osnabrueck, PyPI pelorus, MIT or Apache-2.0). Uses lidar and IMU.

Settings are the package's default configuration with the rig's extrinsics, and the vendor Ouster, whose points have
times in nanoseconds. The poses are those of the lidar."""
import tempfile
import time

import numpy as np
import pelorus

from poses import Track
from recording import Recording

ORIGIN_S = 1000  # the times of the package are unsigned
PATIENCE_S = 2.0
CONFIGURATION = """lidar {{
  vendor = Ouster
}}
imu {{
  from_lidar_transform {{
    translation = [{x:.6f}m, {y:.6f}m, {z:.6f}m]
    rotation = [ [{r[0]:.9f}, {r[1]:.9f}, {r[2]:.9f}],
                 [{r[3]:.9f}, {r[4]:.9f}, {r[5]:.9f}],
                 [{r[6]:.9f}, {r[7]:.9f}, {r[8]:.9f}] ]
  }}
}}
output {{
  terminal {{
    ui = false
  }}
}}
"""


def matrix(odometry: dict) -> np.ndarray:
    w, x, y, z = odometry["orientation"]
    T = np.eye(4)
    T[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                 [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                 [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    T[:3, 3] = odometry["position"]
    return T


def run(sensors: Recording) -> Track:
    x, y, z = sensors.T_IL[:3, 3]
    with tempfile.NamedTemporaryFile("w", suffix=".rl") as file:
        file.write(CONFIGURATION.format(x=x, y=y, z=z, r=sensors.T_IL[:3, :3].ravel()))
        file.flush()
        odometry = pelorus.Handle(file.name)
    track, fed = Track([], [], "lidar"), 0

    def take(patience_s: float) -> None:
        until = time.monotonic() + patience_s
        while True:
            out = odometry.try_recv()
            if out is not None:
                track.time_ns.append((out["timestamp_sec"] - ORIGIN_S) * 1_000_000_000 + out["timestamp_nanosec"])
                track.T_WA.append(matrix(out))
                return
            if time.monotonic() > until:
                return
            time.sleep(0.001)

    for sweep in sensors.sweeps:
        upto = sensors.until(sweep.end_ns + 2 * sensors.period_ns, fed)
        for k in range(fed, upto):
            seconds, rest = divmod(int(sensors.time_ns[k]), 1_000_000_000)
            odometry.add_imu(timestamp_sec=ORIGIN_S + seconds, timestamp_nanosec=rest, orientation=[1.0, 0.0, 0.0, 0.0],
                             orientation_covariance=[-1.0] + [0.0] * 8, angular_velocity=list(sensors.gyro_I_rad_s[k]),
                             angular_velocity_covariance=[0.0] * 9, linear_acceleration=list(sensors.accel_I_m_s2[k]),
                             linear_acceleration_covariance=[0.0] * 9)
        fed = upto
        seconds, rest = divmod(sweep.start_ns, 1_000_000_000)
        odometry.add_pointcloud(np.column_stack([sweep.points_L_m, sweep.offset_ns]), timestamp_sec=ORIGIN_S + seconds,
                                timestamp_nanosec=rest)
        take(PATIENCE_S)
    return track
