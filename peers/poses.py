# SPDX-License-Identifier: BSD-3-Clause
"""Converts the poses of an external estimator to a world with z up, and writes a TUM file."""
import dataclasses
import os

import numpy as np

from recording import Recording

REST_S = 1.0   # in every scenario of the rig, the rig rests at least this long at the start (scenarios/catalogue)
LATE_S = 1.5   # if the first pose is later, the estimator has missed a part of the motion


@dataclasses.dataclass
class Track:
    """Poses of the lidar or the IMU in the world frame of the external estimator, which has arbitrary axes."""
    time_ns: list
    T_WA: list   # 4 x 4
    frame: str   # "lidar" or "imu", as in the peer's YAML


def up_in(frame: str, sensors: Recording) -> np.ndarray:
    """Returns the up direction in sensor axes, from the mean specific force of the first second, at rest."""
    resting = sensors.time_ns <= sensors.time_ns[0] + int(REST_S * 1e9)
    up = sensors.accel_I_m_s2[resting].mean(axis=0)
    if frame == "lidar":
        up = sensors.T_IL[:3, :3].T @ up
    return up / np.linalg.norm(up)


def turning(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Returns the smallest rotation that maps the unit vector a to b. The vectors must not be opposite."""
    v, c = np.cross(a, b), float(a @ b)
    cross = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.eye(3) + cross + cross @ cross / (1.0 + c)


def levelled(track: Track, sensors: Recording) -> Track:
    """Returns the trajectory in a world with z up, whose origin is the first pose. If the first pose is at most LATE_S
    late, this pose is also used for the start of the recording, because the rig is at rest then."""
    if not track.time_ns:
        raise SystemExit("the peer gave no pose")
    level = np.eye(4)
    level[:3, :3] = turning(up_in(track.frame, sensors), np.array([0.0, 0.0, 1.0]))
    begin = level @ np.linalg.inv(track.T_WA[0])
    times, T_WA = list(track.time_ns), [begin @ T for T in track.T_WA]
    start_ns = int(sensors.time_ns[0])
    if start_ns < times[0] <= start_ns + int(LATE_S * 1e9):
        times.insert(0, start_ns)
        T_WA.insert(0, T_WA[0])
    return Track(times, T_WA, track.frame)


def quaternion_xyzw(R: np.ndarray) -> np.ndarray:
    """Returns the Hamilton quaternion of a rotation, as the eigenvector of the largest eigenvalue (Bar-Itzhack, 2000)."""
    k = np.array([[R[0, 0] - R[1, 1] - R[2, 2], 0, 0, 0],
                  [R[0, 1] + R[1, 0], R[1, 1] - R[0, 0] - R[2, 2], 0, 0],
                  [R[0, 2] + R[2, 0], R[1, 2] + R[2, 1], R[2, 2] - R[0, 0] - R[1, 1], 0],
                  [R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1], R[0, 0] + R[1, 1] + R[2, 2]]]) / 3.0
    values, vectors = np.linalg.eigh(k)
    return vectors[:, np.argmax(values)]


def write_tum(path: str, track: Track) -> None:
    """Writes lines `t x y z qx qy qz qw`, with t in seconds from the start of the recording. The file gets its name
    when complete."""
    with open(path + ".part", "w") as out:
        for time_ns, T in zip(track.time_ns, track.T_WA):
            seconds, rest = divmod(int(time_ns), 1_000_000_000)
            values = [*T[:3, 3], *quaternion_xyzw(T[:3, :3])]
            if not np.all(np.isfinite(values)):
                raise SystemExit(f"the pose at {time_ns} ns is not finite")
            print(f"{seconds}.{rest:09d}", *(f"{value:.9f}" for value in values), file=out)
    os.replace(path + ".part", path)
