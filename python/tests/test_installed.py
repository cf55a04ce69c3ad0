# SPDX-License-Identifier: BSD-3-Clause
"""Uses the installed package without the program `tumble` and without pytest: tools/release runs this file with the new wheels."""
import numpy as np

import tumble


def test_a_robot_at_rest_maps_its_room():
    azimuth, elevation = np.meshgrid(np.arange(0.0, 2.0 * np.pi, 0.01), np.radians(np.arange(-15.0, 16.0, 2.0)))
    rays = np.stack([np.cos(azimuth) * np.cos(elevation), np.sin(azimuth) * np.cos(elevation), np.sin(elevation)], axis=-1).reshape(-1, 3)
    points_m = rays / np.max(np.abs(rays) / (4.0, 3.0, 1.0), axis=1, keepdims=True)  # walls, floor and ceiling
    offset_ns = (azimuth / (2.0 * np.pi) * 1e8).astype(np.int64).ravel()
    odometry = tumble.TumblingOdometry(imu=tumble.sheets.mti30(), T_IL=np.eye(4), lever_arm_m=(0.0, 0.0, 0.0))
    for start_ns in range(0, 1_000_000_000, 100_000_000):
        odometry.add_imu(start_ns + 10_000_000 * np.arange(1, 11), np.zeros((10, 3)), np.tile([0.0, 0.0, 9.80665], (10, 1)))
        odometry.add_sweep(start_ns, start_ns + 100_000_000, points_m, offset_ns)
    odometry.finish()
    assert sum(sweep.placed for sweep in odometry.take_all()) == 10
    assert np.linalg.norm(odometry.newest().position) < 1e-3
    assert np.allclose(np.max(np.abs(odometry.map().position) / (4.0, 3.0, 1.0), axis=1), 1.0, atol=1e-2)


if __name__ == "__main__":
    test_a_robot_at_rest_maps_its_room()
    print(tumble.__version__)
