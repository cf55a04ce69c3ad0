# SPDX-License-Identifier: BSD-3-Clause
"""What truly happened in a recording: the group `truth` of its file (scenarios/recordings/FORMAT.md)."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .hdf5 import Group

Array = npt.NDArray[Any]


@dataclass
class Truth:
    """What truly happened, at equal steps of period_ns from time 0; of a real recording what another instrument saw."""

    period_ns: int
    position: Array  #: (N, 3), m: centre of mass in W
    quaternion: Array  #: (N, 4), x y z w, body to world
    velocity: Array  #: (N, 3), m/s
    rate: Array  #: (N, 3), rad/s, of the body in W, body axes
    label: Array  #: (N,) uint8: 0 air, 1 grip, 2 slip, 3 slide; no row where it is not known
    p_BG_m: Array  #: (3,), geometric centre in the body
    imu_rate: list[Array]  #: per IMU: (M, 3), rad/s, the exact mean rate over each sample's window, IMU axes
    imu_T_BI: list[Array]

    @property
    def time_ns(self) -> Array:
        """(N,) int64."""
        return np.arange(len(self.position), dtype=np.int64) * self.period_ns


def read_truth(group: Group) -> Truth:
    """Of the group `truth`."""
    imus = group.members("imus")
    return Truth(period_ns=group.attribute("period_ns", int), position=group.rows("p_WB_m", "f8", (3,)),
                 quaternion=group.rows("q_WB", "f8", (4,)), velocity=group.rows("v_WB_m_s", "f8", (3,)),
                 rate=group.rows("w_WB_B_rad_s", "f8", (3,)), label=group.rows("label", "u1"),
                 p_BG_m=group.rows("p_BG_m", "f8", (3,))[0], imu_rate=[each.rows("rate_I_rad_s", "f8", (3,)) for each in imus],
                 imu_T_BI=[each.rows("T_BI", "f8", (4,)) for each in imus])
