# SPDX-License-Identifier: BSD-3-Clause
"""Reads recordings (scenarios/recordings/FORMAT.md) and estimates (scenarios/estimates/ESTIMATE.md) as numpy arrays.

Frames as in docs/design.md: W world, B body, I the first IMU, A the frame of an estimate. Quaternions are x y z w.
"""
from __future__ import annotations

import json
import pathlib
import shutil

import numpy as np


class Recording:
    """The first IMU of a recording, and its truth.

    clipped           (N,) true if saturation of the gyro changed the sample
    clipped_elements  (N,) number of saturated sensing elements, 0 to 3
    """

    def __init__(self, path: pathlib.Path):
        import h5py  # imported here, because functions on arrays do not need h5py

        with h5py.File(path) as file:
            imu, true_imu, truth = file["sensors/imus/0"], file["truth/imus/0"], file["truth"]
            self.time_s = imu["time_ns"][:] * 1e-9
            self.gyro_rad_s = imu["gyro_I_rad_s"][:]
            self.true_rate_rad_s = true_imu["rate_I_rad_s"][:]
            self.true_force_m_s2 = true_imu["specific_force_I_m_s2"][:]
            lost = self.gyro_rad_s - true_imu["gyro_unclipped_I_rad_s"][:]
            elements = true_imu["gyro_elements_I"][:] if "gyro_elements_I" in true_imu else np.eye(3)
            # a saturation deficit below the noise of one sample does not count as clipping: scenarios/scoring/clipping.hpp
            noise_rad_s = imu.attrs["gyro_noise_rad_s_sqrt_hz"] / np.sqrt(imu.attrs["period_ns"] * 1e-9)
            self.clipped = np.any(np.abs(lost) > max(noise_rad_s, 1e-6), axis=1)
            # a sensing element saturates along its own axis, which differs slightly from the axis of the reading
            self.clipped_elements = np.sum(np.abs(lost @ elements.T) > max(noise_rad_s, 1e-6), axis=1)
            self.R_BI = true_imu["T_BI"][:][:3, :3]
            self.p_BI_m = true_imu["T_BI"][:][:3, 3]
            self.p_BG_m = truth["p_BG_m"][0]
            self.truth_time_s = np.arange(len(truth["p_WB_m"])) * truth.attrs["period_ns"] * 1e-9
            self.p_WB_m, self.q_WB = truth["p_WB_m"][:], truth["q_WB"][:]
            self.label = truth["label"][:]

    def true_pose(self, time_s: np.ndarray, frame: str) -> tuple[np.ndarray, np.ndarray]:
        """Returns true positions (N, 3) and rotations (N, 3, 3) of a frame: imu, centre or body."""
        k = np.clip(np.rint(np.asarray(time_s) / (self.truth_time_s[1] - self.truth_time_s[0])).astype(int), 0,
                    len(self.truth_time_s) - 1)
        R_WB = rotations(self.q_WB[k])
        offset = {"imu": self.p_BI_m, "centre": self.p_BG_m, "body": np.zeros(3)}[frame]
        return self.p_WB_m[k] + R_WB @ offset, R_WB @ (self.R_BI if frame == "imu" else np.eye(3))


def state_true_mounting(recording: pathlib.Path, copy: pathlib.Path) -> None:
    """Writes a copy of a recording in which the calibrated mounting of each IMU is the true mounting."""
    import h5py

    copy.parent.mkdir(parents=True, exist_ok=True)
    part = copy.with_suffix(".part")
    shutil.copyfile(recording, part)
    with h5py.File(part, "r+") as file:
        for index in file["sensors/imus"]:
            file[f"sensors/imus/{index}/T_BI"][...] = file[f"truth/imus/{index}/T_BI"][:]
        file.attrs["digest"] = ""  # the digest is that of the original recording
        del file["sensors"].attrs["digest"]
    part.rename(copy)


class Estimate:
    """The estimate of one method for one recording, in a folder."""

    def __init__(self, folder: pathlib.Path):
        self.folder = folder
        description = json.loads((folder / "estimate.json").read_text())
        self.frame, self.status = description["frame"], description["status"]["trouble"]

    def poses(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Returns times (N,) in seconds, positions (N, 3) and rotations (N, 3, 3) in the estimate's world."""
        name = "trajectory.tum" if (self.folder / "trajectory.tum").is_file() else "attitude.tum"
        rows = np.loadtxt(self.folder / name, ndmin=2)
        return rows[:, 0], rows[:, 1:4], rotations(rows[:, 4:8])

    def rates_rad_s(self) -> np.ndarray:
        """Returns the rates (N, 3) in the axes of the first IMU, one row for each of its samples."""
        return np.loadtxt(self.folder / "rates.csv", delimiter=",", skiprows=1, usecols=(1, 2, 3))

    def map_m(self) -> np.ndarray:
        """Returns the points (N, 3) of the map in the estimate's world."""
        data = (self.folder / "map.ply").read_bytes()
        begin = data.index(b"end_header\n") + len(b"end_header\n")
        return np.frombuffer(data[begin:], dtype="<f4").reshape(-1, 7)[:, :3].astype(float)


def rotations(q: np.ndarray) -> np.ndarray:
    """Converts quaternions (N, 4) to rotation matrices (N, 3, 3)."""
    x, y, z, w = (q / np.linalg.norm(q, axis=1, keepdims=True)).T
    rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    return np.moveaxis(np.array(rows), 2, 0)


def angles_rad(R: np.ndarray) -> np.ndarray:
    """Returns the angles (N,) of rotations (N, 3, 3), also accurate for small angles."""
    skew = np.stack([R[:, 2, 1] - R[:, 1, 2], R[:, 0, 2] - R[:, 2, 0], R[:, 1, 0] - R[:, 0, 1]], axis=1)
    return np.arctan2(np.linalg.norm(skew, axis=1), np.trace(R, axis1=1, axis2=2) - 1)


def yaw_alignment(R_est: np.ndarray, R_true: np.ndarray) -> np.ndarray:
    """Returns the rotation about the vertical that aligns the estimate's world with the true world at one pose."""
    R = R_true @ R_est.T
    yaw = np.arctan2(R[1, 0] - R[0, 1], R[0, 0] + R[1, 1])
    return np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])


def pose_distances(recording: Recording, estimate: Estimate) -> tuple[np.ndarray, np.ndarray]:
    """Returns times (N,) in seconds and angles (N,) in rad between estimated and true attitude, aligned in yaw at the first pose."""
    time_s, _, R_est = estimate.poses()
    _, R_true = recording.true_pose(time_s, estimate.frame)
    aligned = yaw_alignment(R_est[0], R_true[0]) @ R_est
    return time_s, angles_rad(np.swapaxes(R_true, 1, 2) @ aligned)


def map_in_world(recording: Recording, estimate: Estimate) -> np.ndarray:
    """Returns points of a map (N, 3) in the true world, aligned in position and yaw at the first pose."""
    time_s, p, R = estimate.poses()
    p_true, R_true = recording.true_pose(time_s[:1], estimate.frame)
    turn = yaw_alignment(R[0], R_true[0])
    return (estimate.map_m() - p[0]) @ turn.T + p_true[0]
