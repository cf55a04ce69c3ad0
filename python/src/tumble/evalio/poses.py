# SPDX-License-Identifier: BSD-3-Clause
"""Converts poses to and from evalio."""
from __future__ import annotations

import os
from typing import Any

import numpy as np
import numpy.typing as npt

from ..estimates import Trajectory, read_tum
from ..placing import rotations
from ..recordings import Imu
from .clouds import ORIGIN_NS
from .needed import needed_evalio

needed_evalio()
from evalio import types  # noqa: E402

Array = npt.NDArray[Any]


def pose(T: Array) -> types.SE3:
    return types.SE3(types.SO3.from_mat(np.ascontiguousarray(T[:3, :3])), T[:3, 3])


def read_poses(path: str | os.PathLike[str], imu: Imu | None = None) -> Trajectory:
    """Reads poses of the IMU from a file that `evalio run` wrote for this data set. Times are those of the recording. `write_tum` and
    `score` accept the result.

    imu: IMU of the recording, stationary for its first second. If given, the whole trajectory is rotated so that roll and pitch of the
    first pose agree with the measured gravity; the yaw is unchanged. Use `imu` for pipelines whose world frame is their first pose. The
    pipeline `tumble` already has a level world frame.
    """
    out = read_tum(path, separator=",")
    out.time_ns = out.time_ns - ORIGIN_NS
    if imu is not None and len(out):
        resting = imu.time_ns <= imu.time_ns[0] + 10**9
        up = imu.accel[resting].mean(axis=0)
        turn = _turning(rotations(out.quaternion[:1])[0] @ (up / np.linalg.norm(up)))
        out.position = (out.position - out.position[0]) @ rotations(turn[None])[0].T
        out.quaternion = _product(turn, out.quaternion)
    return out


def _turning(up: Array) -> Array:
    """Returns the smallest rotation that maps a unit vector to z, as a quaternion."""
    half = np.array([up[1], -up[0], 0.0, 1.0 + up[2]])
    return half / np.linalg.norm(half) if np.linalg.norm(half) > 1e-9 else np.array([1.0, 0.0, 0.0, 0.0])


def _product(p: Array, q: Array) -> Array:
    """Multiplies a quaternion by each row of (N, 4), x y z w."""
    vector = p[3] * q[:, :3] + q[:, 3:] * p[:3] + np.cross(p[:3], q[:, :3])
    return np.concatenate([vector, p[3] * q[:, 3:] - q[:, :3] @ p[:3, None]], axis=1)
