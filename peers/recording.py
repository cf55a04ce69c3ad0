# SPDX-License-Identifier: BSD-3-Clause
"""Reads the sensors of a recording as numpy arrays: SI units, int64 nanoseconds from its start, frames as in docs/design.md."""
import dataclasses

import h5py
import numpy as np

# Box of the rig's cage, in lidar axes [m]. The mapper of this project removes returns within this box
# (estimator/include/tumble/mapping/lidar_inertial_odometry.hpp), and so does this script for all external estimators.
OWN_BODY_L_M = np.array([[-0.5, -0.4, -0.27], [0.5, 0.4, 0.23]])
SEQUENCE_NS = 50_000  # all rings of the RS-16 fire once in it (models/sensors/rs16.yaml)


@dataclasses.dataclass
class Sweep:
    """One turn of the lidar with N raw returns, not deskewed. Returns from the robot itself are removed."""
    start_ns: int
    end_ns: int            # end of the sweep period, which may be later than the last return
    points_L_m: np.ndarray  # (N, 3) float64
    offset_ns: np.ndarray   # (N,) int64 since start_ns
    ring: np.ndarray        # (N,) int, from bottom to top
    intensity: np.ndarray   # (N,) float32

    def organised(self, rings: int, columns: int) -> np.ndarray:
        """Returns the index of the return in each cell of rings x columns; -1 for an empty cell."""
        cells = np.full((rings, columns), -1)
        column = np.minimum(self.offset_ns // SEQUENCE_NS, columns - 1)
        cells[self.ring, column] = np.arange(len(self.ring))
        return cells


@dataclasses.dataclass
class Recording:
    """The first IMU, and the first lidar if there is one."""
    time_ns: np.ndarray        # (N,) int64, end of each sample's window
    gyro_I_rad_s: np.ndarray   # (N, 3)
    accel_I_m_s2: np.ndarray   # (N, 3), +9.8 up at rest
    period_ns: int
    gyro_noise_rad_s_sqrt_hz: float
    accel_noise_m_s2_sqrt_hz: float
    gyro_range_rad_s: float
    accel_range_m_s2: float
    lever_arm_I_m: np.ndarray  # (3,) from the centre of mass to the IMU
    gravity_m_s2: float
    T_IL: np.ndarray           # 4 x 4
    sweeps: list[Sweep]

    def until(self, end_ns: int, begun: int) -> int:
        """Returns the number of IMU samples until end_ns, but at least `begun`. At this time, a sweep is complete."""
        return max(begun, int(np.searchsorted(self.time_ns, end_ns, side="right")))


def read_sweeps(lidar) -> list[Sweep]:
    """Returns all sweeps that have returns."""
    first = lidar["sweep_first"][:].astype(int)
    starts, period_ns = lidar["sweep_start_ns"][:], int(lidar.attrs["sweep_period_ns"])
    points = lidar["position_L_m"][:].astype(float)
    offset, ring, intensity = (lidar[name][:] for name in ("offset_ns", "ring", "intensity"))
    own = np.all((points > OWN_BODY_L_M[0]) & (points < OWN_BODY_L_M[1]), axis=1)
    sweeps = []
    for start_ns, begin, end in zip(starts, first, first[1:]):
        kept = begin + np.flatnonzero(~own[begin:end])
        if len(kept):
            sweeps.append(Sweep(int(start_ns), int(start_ns) + period_ns, points[kept], offset[kept].astype(np.int64),
                                ring[kept].astype(int), intensity[kept]))
    return sweeps


def read(path: str) -> Recording:
    """Reads a recording (scenarios/recordings/FORMAT.md) without its truth."""
    with h5py.File(path) as file:
        imu = file["sensors/imus/0"]
        T_BI, T_IL, sweeps = imu["T_BI"][:], np.eye(4), []
        if "sensors/lidars/0" in file:
            lidar = file["sensors/lidars/0"]
            T_IL = np.linalg.inv(T_BI) @ lidar["T_BL"][:]
            sweeps = read_sweeps(lidar)
        return Recording(imu["time_ns"][:], imu["gyro_I_rad_s"][:], imu["accel_I_m_s2"][:], int(imu.attrs["period_ns"]),
                         float(imu.attrs["gyro_noise_rad_s_sqrt_hz"]), float(imu.attrs["accel_noise_m_s2_sqrt_hz"]),
                         float(imu.attrs["stated_gyro_range_rad_s"]), float(imu.attrs["stated_accel_range_m_s2"]),
                         T_BI[:3, :3].T @ T_BI[:3, 3],
                         float(file["sensors"].attrs["gravity_m_s2"]), T_IL, sweeps)
