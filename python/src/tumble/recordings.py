# SPDX-License-Identifier: BSD-3-Clause
"""Reads and writes recordings (HDF5, scenarios/recordings/FORMAT.md) as arrays with h5py: `pip install tumble[files]`."""
from __future__ import annotations

import os
import pathlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from .checks import having, number_from, path_of, refusal, rigid, rising, unmasked, whole
from .errors import TumbleError
from .files import beside, optional
from .hdf5 import XYZ, Group, missing, put, same_length
from .shown import Shown
from .truth import Truth, read_truth, require_quantity, write_truth

Array = npt.NDArray[Any]


@dataclass(repr=False)
class Imu(Shown):
    """Samples of one IMU. T_BI (4, 4) is its pose in body axes, relative to the centre of mass. 0 for a range or density means unknown."""

    time_ns: Array  #: (N,) int64, end of each sample's window
    gyro: Array  #: (N, 3), rad/s, IMU axes
    accel: Array  #: (N, 3), m/s^2: specific force, +9.8 up at rest
    T_BI: Array = field(default_factory=lambda: np.eye(4))
    clip_flags: Array | None = None  #: (N,) uint8, bits gyro x y z, accel x y z, as reported by the device; None: not reported
    name: str = "imu"
    device: str = ""
    period_ns: int = 0  #: sample period; 0: the median of the time steps
    gyro_range_rad_s: float = 0.0
    accel_range_m_s2: float = 0.0
    gyro_noise_rad_s_sqrt_hz: float = 0.0
    accel_noise_m_s2_sqrt_hz: float = 0.0
    magnetic_field_t: Array | None = None  #: (N, 3), tesla, IMU axes; None: no magnetometer
    earth_field_t: Array | None = None  #: (3,), tesla, W: field without magnetic disturbances

    def __len__(self) -> int:
        return len(self.time_ns)

    @property
    def lever_arm_m(self) -> Array:
        """Vector from the centre of mass to the IMU, in IMU axes."""
        return self.T_BI[:3, :3].T @ self.T_BI[:3, 3]

    @property
    def samples(self) -> tuple[Array, Array, Array, Array | None]:
        """Returns time_ns, gyro, accel, clip_flags, in the order of the arguments of the estimators."""
        return self.time_ns, self.gyro, self.accel, self.clip_flags


@dataclass(repr=False)
class Sweep(Shown):
    """One sweep of a lidar. The arrays are views of the recording."""

    start_ns: int
    end_ns: int
    position: Array  #: (M, 3) float32, m, in lidar axes at the time of each point
    offset_ns: Array  #: (M,) uint32, time after the start
    ring: Array  #: (M,) uint16
    intensity: Array  #: (M,) float32


@dataclass(repr=False)
class Lidar(Shown):
    """Returns of a lidar, in order of sweeps. T_BL (4, 4) is the pose of the lidar in body axes."""

    sweep_start_ns: Array  #: (S,) int64
    sweep_first: Array  #: (S + 1,) uint64, index of each sweep's first point
    position: Array  #: (P, 3) float32, m
    offset_ns: Array  #: (P,) uint32
    sweep_period_ns: int
    T_BL: Array = field(default_factory=lambda: np.eye(4))
    range_m: Array | None = None  #: (P,) float32; by default the norm of `position`
    intensity: Array | None = None  #: (P,) float32, as reported by the device; by default 0
    ring: Array | None = None  #: (P,) uint16, index of the laser; by default 0
    name: str = "lidar"
    device: str = ""
    point_times: str = "measured"  #: or "not_skewed", "unknown"

    def __post_init__(self) -> None:
        count = len(self.position)
        if self.range_m is None:
            self.range_m = np.linalg.norm(self.position, axis=1).astype(np.float32) if count else np.zeros(0, np.float32)
        if self.intensity is None:
            self.intensity = np.zeros(count, np.float32)
        if self.ring is None:
            self.ring = np.zeros(count, np.uint16)

    def __len__(self) -> int:
        return len(self.sweep_start_ns)

    def __getitem__(self, index: int) -> Sweep:
        """Returns sweep `index`. A sweep ends after the sweep period, or when the next sweep starts, whichever is earlier.

        Points more than one microsecond after the end are dropped. If points have no individual times, the sweep has zero length and all
        points belong to its start.
        """
        count = len(self)
        if not -count <= index < count:
            raise IndexError(f"sweep {index} of {count}")
        index %= count
        start = int(self.sweep_start_ns[index])
        length = self.sweep_period_ns if self.point_times == "measured" else 0
        first = int(self.sweep_first[index])
        rows: slice | Array = slice(first, int(self.sweep_first[index + 1]))
        offsets = self.offset_ns[rows]
        if index + 1 < count and (until_next := int(self.sweep_start_ns[index + 1]) - start) < length:
            length = until_next
            if len(offsets) > 0 and offsets.max() > length:
                rows = first + np.flatnonzero(offsets <= length + ROUNDING_NS)
                offsets = np.minimum(self.offset_ns[rows], length).astype(offsets.dtype)
        assert self.ring is not None and self.intensity is not None
        return Sweep(start, start + length, self.position[rows], offsets, self.ring[rows], self.intensity[rows])

    def __iter__(self) -> Iterator[Sweep]:
        return (self[k] for k in range(len(self)))


@dataclass(repr=False)
class Series(Shown):
    """Samples of any other sensor: one number per time and quantity, for example `series["pressure_pa"]`. T_BX (4, 4) is its pose in body axes."""

    time_ns: Array  #: (N,) int64, end of each sample's window
    values: dict[str, Array]  #: by quantity, (N,) float64; the name of a quantity ends in its unit
    units: dict[str, str] = field(default_factory=dict)  #: by quantity, for example "Pa"
    noise: dict[str, float] = field(default_factory=dict)  #: by quantity: stated standard deviation of a reading; 0: not stated
    constants: dict[str, float] = field(default_factory=dict)  #: known constants of the sensor; names end in their units
    T_BX: Array = field(default_factory=lambda: np.eye(4))
    name: str = "series"
    kind: str = ""  #: for example "barometer"
    device: str = ""
    period_ns: int = 0  #: sample period; 0: the median of the time steps

    def __len__(self) -> int:
        return len(self.time_ns)

    def __getitem__(self, quantity: str) -> Array:
        return self.values[quantity]


@dataclass(repr=False)
class Recording(Shown):
    """A recording: sensor data, and ground truth if it is known."""

    imus: list[Imu] = field(default_factory=list)  #: the first is the primary IMU
    lidars: list[Lidar] = field(default_factory=list)
    robot: str = ""  #: "rig", "sphere", "pendulum", or ""
    sphere_radius_m: float = 0.0
    gravity_m_s2: float = 9.80665
    scenario: str = ""
    seed: int = 0
    situation_yaml: str = ""
    attribution: str = ""  #: for a real recording: author and licence
    origin_ns: int = 0  #: for a real recording: stamp of time 0 in the clock of its source, ns since 1970; 0: unknown
    tumble_version: str = ""  #: version of the program that wrote the recording
    engine_version: str = ""  #: version of MuJoCo
    truth: Truth | None = None  #: ground truth; None: unknown or not read
    series: list[Series] = field(default_factory=list)  #: other sensors, for example a barometer

    @property
    def sweeps(self) -> Lidar:
        """The first lidar. Raises TumbleError `empty` if the recording has no lidar."""
        if not self.lidars:
            raise TumbleError("lidars is empty; it must contain at least one lidar", "empty", "lidars", 0, 1)
        return self.lidars[0]

    @property
    def first_imu(self) -> Imu:
        """The primary IMU. Raises TumbleError `empty` if the recording has no IMU."""
        if not self.imus:
            raise TumbleError("imus is empty; it must contain at least one IMU", "empty", "imus", 0, 1)
        return self.imus[0]

    @property
    def T_IL(self) -> Array:
        """(4, 4), pose of the first lidar in axes of the first IMU, from the two calibrations."""
        T_BI, T_BL = self.first_imu.T_BI, self.sweeps.T_BL
        R = T_BI[:3, :3].T
        out = np.eye(4)
        out[:3, :3] = R @ T_BL[:3, :3]
        out[:3, 3] = R @ T_BL[:3, 3] - R @ T_BI[:3, 3]
        return out


ROUNDING_NS = 1000  # a point at most this long after the end of its sweep is moved to the end

_IMU_NUMBERS = {"stated_gyro_range_rad_s": "gyro_range_rad_s", "stated_accel_range_m_s2": "accel_range_m_s2",
                "gyro_noise_rad_s_sqrt_hz": "gyro_noise_rad_s_sqrt_hz", "accel_noise_m_s2_sqrt_hz": "accel_noise_m_s2_sqrt_hz"}
_TIME_MAX_NS = 10**17  # limit of the program: larger times belong to another clock


def _read_imu(group: Group) -> Imu:
    numbers = {to: group.attribute(name, float) for name, to in _IMU_NUMBERS.items()}
    earth = group.rows("earth_field_W_t", "f8", (3,), optional=True)
    imu = Imu(time_ns=group.rows("time_ns", "i8"), gyro=group.rows("gyro_I_rad_s", "f8", (3,)),
              accel=group.rows("accel_I_m_s2", "f8", (3,)), T_BI=group.rows("T_BI", "f8", (4,)),
              clip_flags=group.rows("clip_flags", "u1"), name=group.attribute("name", str), device=group.attribute("device", str),
              period_ns=group.attribute("period_ns", int), magnetic_field_t=group.rows("magnetic_field_I_t", "f8", (3,), True),
              earth_field_t=None if earth is None else earth[0], **numbers)
    same_length(group.place, imu.time_ns, gyro_I_rad_s=imu.gyro, accel_I_m_s2=imu.accel, clip_flags=imu.clip_flags)
    return imu


def _read_lidar(group: Group) -> Lidar:
    lidar = Lidar(sweep_start_ns=group.rows("sweep_start_ns", "i8"), sweep_first=group.rows("sweep_first", "u8"),
                  position=group.rows("position_L_m", "f4", (3,)), offset_ns=group.rows("offset_ns", "u4"),
                  sweep_period_ns=group.attribute("sweep_period_ns", int), T_BL=group.rows("T_BL", "f8", (4,)),
                  range_m=group.rows("range_m", "f4"), intensity=group.rows("intensity", "f4"), ring=group.rows("ring", "u2"),
                  name=group.attribute("name", str), device=group.attribute("device", str),
                  point_times=group.attribute("point_times", str, "measured"))
    same_length(group.place, lidar.position, range_m=lidar.range_m, intensity=lidar.intensity, offset_ns=lidar.offset_ns,
                 ring=lidar.ring)
    first = lidar.sweep_first
    fits = len(first) == len(lidar) + 1 and first[0] == 0 and first[-1] == len(lidar.position) and np.all(first[1:] >= first[:-1])
    if not fits and (len(lidar) or len(first) or len(lidar.position)):
        raise TumbleError(f"{group.place}/sweep_first must rise from 0 to {len(lidar.position)} over {len(lidar)} sweeps", "file",
                          f"{group.place}/sweep_first", first, len(lidar.position))
    return lidar


def _read_series(group: Group) -> Series:
    quantities = {each.attribute("name", str): each for each in group.members("quantities")}
    series = Series(time_ns=group.rows("time_ns", "i8"), values={name: each.rows("values", "f8") for name, each in quantities.items()},
                    units={name: each.attribute("unit", str) for name, each in quantities.items()},
                    noise={name: each.attribute("noise", float) for name, each in quantities.items()},
                    constants={each.attribute("name", str): each.attribute("value", float) for each in group.members("constants")},
                    T_BX=group.rows("T_BX", "f8", (4,)), name=group.attribute("name", str), kind=group.attribute("kind", str),
                    device=group.attribute("device", str), period_ns=group.attribute("period_ns", int))
    for name, each in quantities.items():
        same_length(each.place, series.time_ns, values=series.values[name])
    return series


def read(path: str | os.PathLike[str], truth: bool = True) -> Recording:
    """Reads the whole recording of an HDF5 file into memory. truth=False: only the data that an estimator may use.

    Raises TumbleError `file` with the place in the file that is missing or has the wrong type or shape, and ImportError without h5py.
    """
    h5py = optional("h5py", "files")
    name = path_of("path", path)
    try:
        file = h5py.File(name, "r")
    except OSError as error:
        raise TumbleError(f"{name} is not a readable HDF5 file: {error}", "file", name, None, "HDF5") from error
    with file:
        try:
            top = Group(file, name)
            if top.attribute("format", str) != "tumble recording":
                raise TumbleError(f"{name} has the format '{top.attribute('format', str)}'; it must be 'tumble recording'", "file", name)
            sensors = Group(file["sensors"], name) if "sensors" in file else None
            if sensors is None:
                raise missing(f"{name}: /sensors")
            seen = truth and bool(top.attribute("has_truth", int, 0))
            return Recording(
                imus=[_read_imu(each) for each in sensors.members("imus")],
                lidars=[_read_lidar(each) for each in sensors.members("lidars")],
                series=[_read_series(each) for each in sensors.members("series")], robot=sensors.attribute("robot", str),
                sphere_radius_m=sensors.attribute("sphere_radius_m", float), gravity_m_s2=sensors.attribute("gravity_m_s2", float),
                scenario=top.attribute("scenario", str), seed=top.attribute("seed", int) % 2**64,
                situation_yaml=top.attribute("situation_yaml", str), attribution=top.attribute("attribution", str, ""),
                origin_ns=top.attribute("origin_ns", int, 0), tumble_version=top.attribute("tumble_version", str, ""),
                engine_version=top.attribute("engine_version", str, ""),
                truth=read_truth(Group(file["truth"], name)) if seen else None)
        except (OSError, RuntimeError, KeyError) as error:  # the file is damaged
            raise TumbleError(f"{name} cannot be read: {error}", "file", name, None, "HDF5") from error


def write(path: str | os.PathLike[str], recording: Recording, truth: bool = True) -> None:
    """Writes a recording as HDF5, which the program accepts like its own recordings. truth=False: only the data that an estimator may use.

    Data that were read and not changed are written without loss, so scores against the ground truth are the same. If samples or points
    are added or removed, the truth of that sensor must have the same number of rows, or none. The digests that the program writes are
    omitted, so the program cannot detect damage to the file. The file is written under a temporary name and then renamed.

    Raises TumbleError:
    shape          arrays that do not fit together
    type           times that are not integers; complex or masked numbers
    time_order     times that do not increase
    out_of_range   values that the program rejects: a range below 0, a T_BI that is not a pose, integers beyond the file's type
    """
    h5py = optional("h5py", "files")
    having("recording", recording, "a Recording", "imus", "lidars", "series", "truth")
    _require_sound(recording)
    with beside(path_of("path", path)) as part, h5py.File(part, "w", libver=("v110", "v110")) as file:
        texts = {"format": "tumble recording", "scenario": recording.scenario, "situation_yaml": recording.situation_yaml,
                 "tumble_version": recording.tumble_version, "engine_version": recording.engine_version,
                 "attribution": recording.attribution, "digest": ""}
        for key, text in texts.items():
            file.attrs[key] = text
        known = recording.truth if truth else None
        for key, number in {"format_version": 1, "seed": recording.seed, "has_truth": known is not None}.items():
            file.attrs[key] = np.int64(np.uint64(number).astype(np.int64))
        if recording.origin_ns != 0:
            file.attrs["origin_ns"] = np.int64(recording.origin_ns)
        sensors = file.create_group("sensors")
        sensors.attrs["robot"] = recording.robot
        sensors.attrs["sphere_radius_m"] = float(recording.sphere_radius_m)
        sensors.attrs["gravity_m_s2"] = float(recording.gravity_m_s2)
        imus, lidars = sensors.create_group("imus"), sensors.create_group("lidars")
        for k, imu in enumerate(recording.imus):
            _write_imu(imus.create_group(str(k)), imu)
        for k, lidar in enumerate(recording.lidars):
            _write_lidar(lidars.create_group(str(k)), lidar)
        if recording.series:  # a recording without other sensors has no such group
            others = sensors.create_group("series")
            for k, series in enumerate(recording.series):
                _write_series(others.create_group(str(k)), series)
        if known is not None:
            write_truth(file.create_group("truth"), known, [len(imu) for imu in recording.imus],
                        [len(lidar.position) for lidar in recording.lidars], [len(series) for series in recording.series])


def _require_sound(recording: Recording) -> None:
    """Raises the errors that the program's reader would report (scenarios/recordings/recording_check.cpp). `put` checks lengths and types."""
    for name in ("sphere_radius_m", "gravity_m_s2"):
        number_from(name, getattr(recording, name), 0.0)
    whole("seed", recording.seed, 0, 2**64 - 1)
    whole("origin_ns", recording.origin_ns, -(2**63), 2**63 - 1)
    for k, imu in enumerate(recording.imus):
        place = f"imus[{k}]"
        for name in _IMU_NUMBERS.values():
            number_from(f"{place}.{name}", getattr(imu, name), 0.0)
        whole(f"{place}.period_ns", imu.period_ns, 0, 2**63 - 1)
        rigid(f"{place}.T_BI", imu.T_BI)
        _require_times(f"{place}.time_ns", imu.time_ns)
        if imu.earth_field_t is not None and not np.isfinite(unmasked(f"{place}.earth_field_t", imu.earth_field_t)).all():
            raise refusal("non_finite", f"{place}.earth_field_t", imu.earth_field_t, "finite")
    for k, lidar in enumerate(recording.lidars):
        place = f"lidars[{k}]"
        whole(f"{place}.sweep_period_ns", lidar.sweep_period_ns, 1, 2**63 - 1)
        rigid(f"{place}.T_BL", lidar.T_BL)
        _require_times(f"{place}.sweep_start_ns", lidar.sweep_start_ns)
    for k, series in enumerate(recording.series):
        place = f"series[{k}]"
        whole(f"{place}.period_ns", series.period_ns, 0, 2**63 - 1)
        rigid(f"{place}.T_BX", series.T_BX)
        _require_times(f"{place}.time_ns", series.time_ns)
        for name in series.values:
            require_quantity(f"{place}.values", name)
            number_from(f"{place}.noise[{name}]", series.noise.get(name, 0.0), 0.0)
        for name, number in series.constants.items():
            require_quantity(f"{place}.constants", name)
            number_from(f"{place}.constants[{name}]", number)


def _require_times(field: str, given: Any) -> None:
    times = unmasked(field, given)
    if times.ndim != 1 or times.dtype.kind not in "iu":
        return  # `put` reports this error
    rising(field, times)
    for number in times[[0, -1]] if len(times) else ():
        whole(field, number, -_TIME_MAX_NS, _TIME_MAX_NS)


def _write_imu(group: Any, imu: Imu) -> None:
    count = len(imu.time_ns)
    period = imu.period_ns or (int(np.median(np.diff(imu.time_ns))) if count > 1 else 1)
    group.attrs["name"], group.attrs["device"], group.attrs["period_ns"] = imu.name, imu.device, np.int64(period)
    for name, own in _IMU_NUMBERS.items():
        group.attrs[name] = float(getattr(imu, own))
    put(group, "T_BI", imu.T_BI, "<f8", "1, last column m", (4, 4), many=False)
    put(group, "time_ns", imu.time_ns, "<i8", "ns", (count,))
    put(group, "gyro_I_rad_s", imu.gyro, "<f8", "rad/s", (count, 3), XYZ)
    put(group, "accel_I_m_s2", imu.accel, "<f8", "m/s^2", (count, 3), XYZ)
    flags = np.zeros(count, np.uint8) if imu.clip_flags is None else imu.clip_flags
    put(group, "clip_flags", flags, "u1", "1", (count,))
    if imu.magnetic_field_t is not None:
        put(group, "magnetic_field_I_t", imu.magnetic_field_t, "<f8", "T", (count, 3), XYZ)
    if imu.earth_field_t is not None:
        put(group, "earth_field_W_t", np.reshape(imu.earth_field_t, (1, 3)), "<f8", "T", (1, 3), XYZ, many=False)


def _write_lidar(group: Any, lidar: Lidar) -> None:
    points, sweeps = len(lidar.position), len(lidar.sweep_start_ns)
    group.attrs["name"], group.attrs["device"] = lidar.name, lidar.device
    if lidar.point_times != "measured":
        group.attrs["point_times"] = lidar.point_times
    group.attrs["sweep_period_ns"] = np.int64(lidar.sweep_period_ns)
    put(group, "T_BL", lidar.T_BL, "<f8", "1, last column m", (4, 4), many=False)
    put(group, "sweep_start_ns", lidar.sweep_start_ns, "<i8", "ns", (sweeps,))
    put(group, "sweep_first", lidar.sweep_first, "<u8", "1", (sweeps + 1,))
    put(group, "position_L_m", lidar.position, "<f4", "m", (points, 3), XYZ)
    put(group, "range_m", lidar.range_m, "<f4", "m", (points,))
    put(group, "intensity", lidar.intensity, "<f4", "1", (points,))
    put(group, "offset_ns", lidar.offset_ns, "<u4", "ns", (points,))
    put(group, "ring", lidar.ring, "<u2", "1", (points,))


def _write_series(group: Any, series: Series) -> None:
    count = len(series.time_ns)
    period = series.period_ns or (int(np.median(np.diff(series.time_ns))) if count > 1 else 1)
    group.attrs["name"], group.attrs["kind"], group.attrs["device"] = series.name, series.kind, series.device
    group.attrs["period_ns"] = np.int64(period)
    put(group, "T_BX", series.T_BX, "<f8", "1, last column m", (4, 4), many=False)
    put(group, "time_ns", series.time_ns, "<i8", "ns", (count,))
    quantities = group.create_group("quantities")
    for k, (name, values) in enumerate(series.values.items()):
        own, unit = quantities.create_group(str(k)), series.units.get(name, "")
        own.attrs["name"], own.attrs["unit"], own.attrs["noise"] = name, unit, float(series.noise.get(name, 0.0))
        put(own, "values", values, "<f8", unit, (count,))
    if series.constants:
        constants = group.create_group("constants")
        for k, (name, number) in enumerate(series.constants.items()):
            own = constants.create_group(str(k))
            own.attrs["name"], own.attrs["value"] = name, float(number)
