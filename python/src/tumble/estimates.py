# SPDX-License-Identifier: BSD-3-Clause
"""Reads and writes estimates: poses in TUM format, and the folders that the program writes (scenarios/estimates/ESTIMATE.md)."""
from __future__ import annotations

import json
import os
import pathlib
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from .checks import having, path_of, refusal, unmasked
from .errors import TumbleError
from .files import beside
from .shown import Shown

Array = npt.NDArray[Any]


@dataclass(repr=False)
class Trajectory(Shown):
    """Poses of a frame in the world, in order of time."""

    time_ns: Array  #: (N,) int64
    position: Array  #: (N, 3), m
    quaternion: Array  #: (N, 4), x y z w

    def __len__(self) -> int:
        return len(self.time_ns)


def write_tum(path: str | os.PathLike[str], poses: Any) -> None:
    """Writes poses in TUM format: `t x y z qx qy qz qw`, with t in seconds, exact to the nanosecond.

    poses: an object with time_ns, quaternion and, optionally, position (default: 0). `read_tum` restores the numbers bit for bit. The file
    is written under a temporary name and then renamed.
    """
    having("poses", poses, "an object with time_ns and quaternion", "time_ns", "quaternion")
    times, quaternions = unmasked("time_ns", poses.time_ns), unmasked("quaternion", poses.quaternion)
    if times.dtype.kind not in "iu":
        raise refusal("type", "time_ns", times.dtype, "int64 (nanoseconds)")
    if times.ndim != 1:
        raise refusal("shape", "time_ns", times.shape, "(N,)")
    positions = unmasked("position", getattr(poses, "position", np.zeros((len(times), 3))))
    for name, rows, columns in (("position", positions, 3), ("quaternion", quaternions, 4)):
        if rows.shape != (len(times), columns):
            raise TumbleError(f"{name} is {rows.shape}; it must be {(len(times), columns)}", "shape", name, rows.shape,
                              (len(times), columns))
        if not np.isfinite(rows).all():
            raise TumbleError(f"{name} contains a number that is not finite", "non_finite", name, float("nan"), "finite")
    with beside(path_of("path", path)) as part, open(part, "w", encoding="ascii") as out:
        for time_ns, p, q in zip(times.tolist(), positions.tolist(), quaternions.tolist(), strict=True):
            sign, whole = ("-", -time_ns) if time_ns < 0 else ("", time_ns)
            print(f"{sign}{whole // 10**9}.{whole % 10**9:09d}", *map(repr, p), *map(repr, q), file=out)


def _nanoseconds(text: str) -> int:
    """Converts seconds to nanoseconds, exactly for a plain decimal. A double cannot represent nanoseconds since 1970."""
    sign, digits = (-1, text[1:]) if text.startswith("-") else (1, text)
    whole, _, part = digits.partition(".")
    if not (whole + part).isdigit() or not (whole + part).isascii():
        return round(float(text) * 1e9)
    nanoseconds = int(whole or "0") * 10**9 + int((part + "0" * 9)[:9])
    return sign * (nanoseconds + (1 if part[9:10] >= "5" else 0))


def read_tum(path: str | os.PathLike[str], separator: str | None = None) -> Trajectory:
    """Reads poses from a TUM file. Lines that start with # are skipped.

    separator: text between the numbers; None: white space. Raises TumbleError `file` with the number of an invalid line.
    """
    name = path_of("path", path)
    times, rows = [], []
    try:
        with open(name, encoding="utf-8") as file:
            for number, line in enumerate(file, start=1):
                words = line.strip().split(separator)
                if not words or not words[0] or words[0].startswith("#"):
                    continue
                try:
                    if len(words) != 8:
                        raise ValueError(f"the line has {len(words)} numbers; it must have 8")
                    times.append(_nanoseconds(words[0]))
                    rows.append([float(word) for word in words[1:]])
                    if not np.isfinite(rows[-1]).all():
                        raise ValueError("a number is not finite")
                except (ValueError, OverflowError) as error:
                    raise TumbleError(f"{name}:{number}: {error}", "file", f"{name}:{number}", line.strip(), "t x y z qx qy qz qw") from error
    except (OSError, UnicodeDecodeError) as error:
        raise TumbleError(f"{name} cannot be read: {error}", "file", name, None, "a TUM file") from error
    numbers = np.array(rows, dtype=float).reshape(-1, 7)
    try:
        stamps = np.array(times, dtype=np.int64)
    except OverflowError as error:
        raise TumbleError(f"{name}: a time exceeds 64 bits of nanoseconds", "file", name, max(times), 2**63 - 1) from error
    return Trajectory(stamps, numbers[:, :3], numbers[:, 3:])


@dataclass(repr=False)
class RateTable(Shown):
    """Angular velocities of an estimate that was read from disk."""

    time_ns: Array  #: (N,) int64
    rate: Array  #: (N, 3), rad/s
    covariance: Array  #: (N, 3, 3)
    clipped_axes: Array  #: (N,) uint8
    source: Array  #: (N,) uint8


@dataclass(repr=False)
class Estimate(Shown):
    """Contents of the folder of an estimate. Members whose file is missing are None."""

    method: str
    kind: str
    frame: str
    status: str  #: "ok", or the error of the run
    health: dict[str, float]  #: health counters of the method, by name
    rates: RateTable | None = None  #: angular velocity of the first IMU
    poses: Trajectory | None = None  #: poses of the frame; an attitude estimate has zero positions
    sweep_poses: Trajectory | None = None  #: poses within sweeps
    sweeps: dict[str, Array] = field(default_factory=dict)  #: columns of sweeps.csv


def _columns(path: pathlib.Path) -> dict[str, Array]:
    """Returns the columns of a CSV file. Columns of times are int64."""
    with open(path, encoding="ascii") as file:
        names = file.readline().strip().split(",")
        rows = [line.strip().split(",") for line in file]
    if any(len(row) != len(names) for row in rows):
        raise TumbleError(f"{path}: a row and the header have different numbers of columns", "file", str(path), None, len(names))
    whole = [name.endswith("_ns") for name in names]
    return {name: np.array([row[k] for row in rows], dtype=np.int64 if whole[k] else float) for k, name in enumerate(names)}


def _rates(path: pathlib.Path) -> RateTable:
    c = _columns(path)
    order = [["cxx", "cxy", "cxz"], ["cxy", "cyy", "cyz"], ["cxz", "cyz", "czz"]]
    covariance = np.stack([np.stack([c[name] for name in row], axis=-1) for row in order], axis=-2)
    return RateTable(c["time_ns"], np.stack([c[f"w{axis}_rad_s"] for axis in "xyz"], axis=-1), covariance,
                     c["clipped_axes"].astype(np.uint8), c["source"].astype(np.uint8))


def read_estimate(folder: str | os.PathLike[str]) -> Estimate:
    """Reads the folder of an estimate. `tumble estimate -o` writes one such folder, and `tumble run -o` writes one per method."""
    root = pathlib.Path(path_of("folder", folder))
    try:
        head = json.loads((root / "estimate.json").read_text(encoding="utf-8"))
        out = Estimate(head["method"], head["kind"], head["frame"], head["status"]["trouble"], head["health"])
        if (root / "rates.csv").exists():
            out.rates = _rates(root / "rates.csv")
        for name in ("trajectory.tum", "attitude.tum"):
            if (root / name).exists():
                out.poses = read_tum(root / name)
        if (root / "sweeps.csv").exists():
            out.sweeps = _columns(root / "sweeps.csv")
        if (root / "sweep_poses.csv").exists():
            c = _columns(root / "sweep_poses.csv")
            out.sweep_poses = Trajectory(c["time_ns"], np.stack([c[f"p{axis}_m"] for axis in "xyz"], axis=-1),
                                         np.stack([c[f"q{axis}"] for axis in "xyzw"], axis=-1))
        return out
    except (OSError, ValueError, KeyError) as error:
        if isinstance(error, TumbleError):
            raise
        raise TumbleError(f"{root} cannot be read as an estimate: {error!r}", "file", str(root), None, "a folder with estimate.json") from error
