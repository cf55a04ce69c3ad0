# SPDX-License-Identifier: BSD-3-Clause
"""Computes world positions of lidar returns from estimated poses and from ground truth, and the distances between them."""
from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .checks import having, whole
from .errors import TumbleError
from .recordings import Recording

Array = npt.NDArray[Any]


def rotations(quaternion: Array) -> Array:
    """Converts quaternions (N, 4), x y z w, to rotation matrices (N, 3, 3). The quaternions need not have unit length."""
    x, y, z, w = (quaternion / np.linalg.norm(quaternion, axis=1, keepdims=True)).T
    rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    return np.moveaxis(np.array(rows), 2, 0)


def poses_at(time_ns: Array, poses: Any) -> tuple[Array, Array]:
    """Interpolates `poses` (time_ns, position, quaternion): positions (N, 3) linearly, rotations (N, 3, 3) by spherical interpolation.

    Returns NaN for times before the first or after the last of `poses`.
    """
    known = np.asarray(poses.time_ns)
    if len(known) < 2:
        raise TumbleError(f"the argument poses has {len(known)} poses; it must have at least 2", "insufficient_data", "poses", len(known), 2)
    k = np.clip(np.searchsorted(known, time_ns, side="right") - 1, 0, len(known) - 2)
    share = ((time_ns - known[k]) / (known[k + 1] - known[k]))[:, None]
    share[(time_ns < known[0]) | (time_ns > known[-1])] = np.nan
    position = (1 - share) * poses.position[k] + share * poses.position[k + 1]
    q0, q1 = np.asarray(poses.quaternion)[k], np.asarray(poses.quaternion)[k + 1]
    cosine = np.sum(q0 * q1, axis=1, keepdims=True)
    q1, angle = np.where(cosine < 0, -q1, q1), np.arccos(np.clip(np.abs(cosine), 0.0, 1.0))
    small = angle < 1e-6
    sine = np.where(small, 1.0, np.sin(angle))
    before = np.where(small, 1 - share, np.sin((1 - share) * angle) / sine)
    after = np.where(small, share, np.sin(share * angle) / sine)
    return position, rotations(before * q0 + after * q1)


def point_errors(recording: Recording, poses: Any, every: int = 1) -> tuple[Array, Array]:
    """Computes the positions of the first lidar's returns from poses of the first IMU, and their distances from the true positions.

    Returns positions (N, 3), m, in the world of the estimate, and distances (N,), m, for the returns within the times of both the poses
    and the ground truth. The worlds are aligned in position and yaw at the first pose within the times of the truth, as for the
    program's scores (`ate_m`). The estimated position uses the calibration stated by the recording, the true position uses the true
    mounting. The distance therefore contains the calibration error. every=n uses every n-th return.
    Raises TumbleError `empty` without ground truth or without returns.
    """
    having("recording", recording, "a Recording", "truth", "imus", "lidars")
    having("poses", poses, "an object with time_ns, position and quaternion", "time_ns", "position", "quaternion")
    every = whole("every", every, 1, 2**63 - 1)
    truth = recording.truth
    if truth is None:
        raise TumbleError("truth is missing; read a recording with ground truth", "empty", "truth", None, "a truth")
    lidar = recording.sweeps
    counts: Array = np.diff(lidar.sweep_first.astype(np.int64))
    time_ns = (np.repeat(lidar.sweep_start_ns, counts) + lidar.offset_ns)[::every]
    returns_L = lidar.position[::every].astype(float)
    returns_I = returns_L @ recording.T_IL[:3, :3].T + recording.T_IL[:3, 3]
    returns_B = returns_L @ lidar.T_BL[:3, :3].T + lidar.T_BL[:3, 3]
    position, R_WI = poses_at(time_ns, poses)
    estimated = position + np.einsum("nij,nj->ni", R_WI, returns_I)
    position, R_WB = poses_at(time_ns, truth)
    true = position + np.einsum("nij,nj->ni", R_WB, returns_B)
    inside = np.isfinite(estimated).all(axis=1) & np.isfinite(true).all(axis=1)
    if not inside.any():
        raise TumbleError("no lidar return is within the times of the poses; at least one return must be", "empty", "poses", 0, 1)
    estimated, true = estimated[inside], true[inside]
    known = np.asarray(poses.time_ns)
    begin = known[(known >= truth.time_ns[0]) & (known <= truth.time_ns[-1])][:1]
    if len(begin) == 0:
        raise TumbleError("no pose is within the times of the truth; at least one pose must be", "empty", "poses", 0, 1)
    p_e, R_e = poses_at(begin, poses)
    p_t, R_t = poses_at(begin, truth)
    T_BI = truth.imu_T_BI[0]
    p_t, R_t = p_t[0] + R_t[0] @ T_BI[:3, 3], R_t[0] @ T_BI[:3, :3]
    turn = R_t @ R_e[0].T
    yaw = np.arctan2(turn[1, 0] - turn[0, 1], turn[0, 0] + turn[1, 1])
    about_z = np.array([[np.cos(yaw), -np.sin(yaw), 0.0], [np.sin(yaw), np.cos(yaw), 0.0], [0.0, 0.0, 1.0]])
    return estimated, np.linalg.norm((estimated - p_e[0]) @ about_z.T + p_t - true, axis=1)
