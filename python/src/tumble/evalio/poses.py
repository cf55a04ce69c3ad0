# SPDX-License-Identifier: BSD-3-Clause
"""Poses to evalio and from it."""
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
    """Poses of the IMU from a file of `evalio run` on this data set, with times of the recording: what `write_tum` and `score` take.

    imu: of the recording, at rest for its first second: the whole way is turned so that the first pose is level as its specific force
    says, with the yaw that it has. For pipelines whose world is their first pose. Ours is level by itself.
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
    """The smallest turn that takes a unit vector to z: a quaternion."""
    half = np.array([up[1], -up[0], 0.0, 1.0 + up[2]])
    return half / np.linalg.norm(half) if np.linalg.norm(half) > 1e-9 else np.array([1.0, 0.0, 0.0, 0.0])


def _product(p: Array, q: Array) -> Array:
    """Of a quaternion with each of (N, 4), x y z w."""
    vector = p[3] * q[:, :3] + q[:, 3:] * p[:3] + np.cross(p[:3], q[:, :3])
    return np.concatenate([vector, p[3] * q[:, 3:] - q[:, :3] @ p[:3, None]], axis=1)
