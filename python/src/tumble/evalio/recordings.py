# SPDX-License-Identifier: BSD-3-Clause
"""Provides recordings of this project as an evalio data set."""
from __future__ import annotations

import os
import pathlib
import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np

from .. import _tumble, sheets
from ..errors import TumbleError
from ..files import optional
from ..program import record
from ..recordings import Recording, read
from ..processing import RIG_BODY_L, sheet_of
from .clouds import Grid, measurement, stamp
from .needed import needed_evalio
from .poses import pose

needed_evalio()
from evalio import types  # noqa: E402
from evalio.datasets import Dataset, RawDataIter  # noqa: E402

#: All scenarios of the rig with a lidar (checked by tests/architecture/registration_test.cpp).
SCENARIOS = ("hill", "scree", "forest", "stairs", "cliff", "bare", "throw", "drop", "stroll", "hill_upright", "hill_consumer",
             "hill_faults")


def seeds() -> range:
    """Returns the seeds of each scenario that the data set lists: $TUMBLE_EVALIO_SEEDS, by default "1..8"."""
    text = os.environ.get("TUMBLE_EVALIO_SEEDS", "1..8")
    first, dots, last = text.partition("..")
    if not (dots and first.isdigit() and last.isdigit() and 0 <= int(last) - int(first) < 10_000):
        raise TumbleError(f"TUMBLE_EVALIO_SEEDS is '{text}'; it must be FIRST..LAST with at most 10000 draws", "out_of_range",
                          "TUMBLE_EVALIO_SEEDS", text, "FIRST..LAST")
    return range(int(first), int(last) + 1)


def files() -> dict[str, pathlib.Path]:
    """Returns the recordings listed in $TUMBLE_EVALIO_FILES (HDF5 files, separated as in PATH), by file name."""
    named = [pathlib.Path(each) for each in os.environ.get("TUMBLE_EVALIO_FILES", "").split(os.pathsep) if each]
    out = {path.stem: path for path in named}
    for path in named:
        if out[path.stem] != path:
            raise TumbleError(f"TUMBLE_EVALIO_FILES has two files named {path.stem}; the names must differ", "file", "TUMBLE_EVALIO_FILES", path.stem, 1)
    return out


def _imu_params(sheet: _tumble.ImuDataSheet, gravity_m_s2: float, device: str) -> types.ImuParams:
    return types.ImuParams(gyro=sheet.gyro_noise_rad_s_sqrt_hz, accel=sheet.accel_noise_m_s2_sqrt_hz, rate=sheet.rate_hz,
                           gravity=np.array([0.0, 0.0, -gravity_m_s2]), brand="simulated", model=device or "-")


def _lidar_params(rows: int, columns: int, rate_hz: float, device: str) -> types.LidarParams:
    sheet = getattr(sheets, device, _tumble.LidarDataSheet)()
    return types.LidarParams(num_rows=rows, num_columns=columns, min_range=sheet.range_min_m, max_range=sheet.range_max_m, rate=rate_hz,
                             brand="simulated", model=device or "-")


def _draws() -> dict[str, tuple[str, int]]:
    return {f"{scenario}_{seed}": (scenario, seed) for scenario in SCENARIOS for seed in seeds()}


class _Sequences(Dataset):
    """Behaviour of each sequence of Recordings."""

    @classmethod
    def dataset_name(cls) -> str:
        return "tumble"

    @staticmethod
    def url() -> str:
        return "-"

    def environment(self) -> str:
        return "simulated"

    def vehicle(self) -> str:
        return "rig that tumbles"

    def files(self) -> list[str | pathlib.Path]:
        return [files().get(self.value, "recording.h5")]

    @property
    def path(self) -> pathlib.Path:
        given = self.files()[0]
        return given if isinstance(given, pathlib.Path) else self.folder / given

    def download(self) -> None:
        """Simulates the sequence with the program."""
        if self.value in files():
            return
        self.folder.mkdir(parents=True, exist_ok=True)
        scenario, seed = _draws()[self.value]
        record(scenario, self.path, seed=seed)

    def recording(self) -> Recording:
        """Reads the recording. Raises TumbleError if it has no IMU or no lidar."""
        out = read(self.path)
        for name in ("imus", "lidars"):
            if not getattr(out, name):
                raise TumbleError(f"{self.path} has no {name}; it must have at least one", "empty", name, 0, 1)
        return out

    def quick_len(self) -> int | None:
        return len(read(self.path, truth=False).sweeps) if self.is_downloaded() else None

    def data_iter(self) -> RawDataIter:
        recording = self.recording()
        imu, lidar = recording.imus[0], recording.sweeps
        grid, own = Grid(lidar), RIG_BODY_L if recording.robot == "rig" else None

        def samples() -> Iterator[types.ImuMeasurement]:
            for time_ns, gyro, accel in zip(imu.time_ns.tolist(), imu.gyro, imu.accel, strict=True):
                yield types.ImuMeasurement(stamp(time_ns), gyro, accel)

        return RawDataIter((measurement(sweep, grid, own) for sweep in lidar), samples(), len(lidar))

    def ground_truth_raw(self) -> Any:
        truth = self.recording().truth
        if truth is None:
            return None
        poses = [types.SE3(types.SO3(qx=q[0], qy=q[1], qz=q[2], qw=q[3]), p) for p, q in zip(truth.position, truth.quaternion, strict=True)]
        return types.Trajectory(stamps=[stamp(int(t)) for t in truth.time_ns], poses=poses)

    def imu_T_lidar(self) -> types.SE3:
        return pose(self.recording().T_IL)

    def imu_T_gt(self) -> types.SE3:
        truth = self.recording().truth
        return pose(np.eye(4) if truth is None else np.linalg.inv(truth.imu_T_BI[0]))

    def imu_params(self) -> types.ImuParams:
        """Returns the parameters that the recording states. Before the simulation, returns the data sheet of the rig's IMU."""
        if not self.path.exists():
            return _imu_params(sheets.mti30(), 9.80665, "mti30")
        recording = self.recording()
        return _imu_params(sheet_of(recording.imus[0]), recording.gravity_m_s2, recording.imus[0].device)

    def lidar_params(self) -> types.LidarParams:
        """Returns the parameters of the lidar, as imu_params does. The ranges come from the device's data sheet, if the package has this sheet."""
        if not self.path.exists():
            return _lidar_params(16, 2000, 10.0, "rs16")
        lidar = self.recording().sweeps
        grid = Grid(lidar)
        return _lidar_params(grid.rows, grid.columns, 1e9 / lidar.sweep_period_ns, lidar.device)


def _lacks(path: pathlib.Path) -> str:
    """Returns why evalio cannot use a file, or "" if it can."""
    try:
        with optional("h5py", "files").File(path, "r") as file:
            return " and ".join(f"no {kind}" for kind in ("imus", "lidars") if not file.get(f"sensors/{kind}"))
    except OSError as error:
        return str(error)


def _fit(named: dict[str, pathlib.Path]) -> dict[str, pathlib.Path]:
    """Returns the files that are recordings with an IMU and a lidar. Warns about each other file and skips it."""
    out = {}
    for name, path in named.items():
        if lacks := _lacks(path):
            warnings.warn(f"TUMBLE_EVALIO_FILES: {path} is skipped: it has {lacks}", stacklevel=2)
        else:
            out[name] = path
    return out


def _sequences() -> dict[str, str]:
    draws, named = _draws(), files()
    if both := sorted(draws.keys() & named.keys()):
        raise TumbleError(f"TUMBLE_EVALIO_FILES has a file named {both[0]}; the name must differ from the names of draws", "file",
                          "TUMBLE_EVALIO_FILES", both[0], "another name")
    return {name: name for name in [*draws, *_fit(named)]}


Recordings = _Sequences("Recordings", _sequences(), module=__name__)  # type: ignore[call-arg]  # an enumeration created at run time
Recordings.__doc__ = """Draws of the rig's scenarios, `hill_1` and so on (`$TUMBLE_EVALIO_SEEDS`), and the HDF5 files of `$TUMBLE_EVALIO_FILES`,
by name. `evalio dl tumble/hill_1` simulates a draw with the program and stores it in evalio's data folder. The ground truth is that of
the body, with the exact mounting. Returns of the lidar from the rig itself are removed."""
