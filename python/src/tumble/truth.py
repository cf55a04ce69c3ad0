# SPDX-License-Identifier: BSD-3-Clause
"""Ground truth of a recording: the group `truth` of its file (scenarios/recordings/FORMAT.md)."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import TumbleError
from .hdf5 import XYZ, Group, put, put_texts
from .shown import Shown

Array = npt.NDArray[Any]


def _none(dtype: str, *columns: int) -> Any:
    """Returns a dataclass field whose default is an array without rows."""
    return field(default_factory=lambda: np.zeros((0, *columns), dtype))


@dataclass(repr=False)
class ImuTruth(Shown):
    """Ground truth of one IMU. N is the number of its samples, or 0 if unknown.

    A reading that differs from the unclipped reading was clipped. A real recording may contain only the rates.
    """

    name: str = ""
    T_BI: Array = field(default_factory=lambda: np.eye(4))  #: (4, 4), true mounting
    rate: Array = _none("f8", 3)  #: (N, 3), rad/s: exact mean over the window of each sample, IMU axes
    specific_force: Array = _none("f8", 3)  #: (N, 3), m/s^2: exact mean over the window of each sample
    gyro_unclipped: Array = _none("f8", 3)  #: (N, 3), rad/s: the reading with all errors except clipping
    accel_unclipped: Array = _none("f8", 3)  #: (N, 3), m/s^2
    gyro_bias: Array = _none("f8", 3)  #: (N, 3), rad/s, at each sample
    accel_bias: Array = _none("f8", 3)  #: (N, 3), m/s^2
    gyro_elements: Array | None = None  #: (3, 3), row i: sensitivity of element i to the axes of the reading; None: aligned with the axes
    gyro_element_offset_rad_s: Array | None = None  #: (3,), subtracted after clipping
    accel_elements: Array | None = None  #: (3, 3), same for the accelerometer
    accel_element_offset_m_s2: Array | None = None  #: (3,)
    magnetic_field_t: Array | None = None  #: (N, 3), T: true mean over the window


@dataclass(repr=False)
class LidarTruth(Shown):
    """True positions of the returns of a lidar. P is the number of its points, or 0 if unknown."""

    name: str = ""
    T_BL: Array = field(default_factory=lambda: np.eye(4))  #: (4, 4), true mounting
    hit: Array = _none("f4", 3)  #: (P, 3) float32, m, W
    surface_id: Array = _none("i4")  #: (P,) int32, index into Truth.surfaces; -1: unknown, -2: cage of the robot


@dataclass(repr=False)
class SeriesTruth(Shown):
    """True values of the sensor of a Series."""

    name: str = ""
    T_BX: Array = field(default_factory=lambda: np.eye(4))  #: (4, 4), true mounting
    values: dict[str, Array] = field(default_factory=dict)  #: by quantity: (N,), exact means; N is the number of samples, or 0; {}: unknown
    units: dict[str, str] = field(default_factory=dict)  #: by quantity

    def __getitem__(self, quantity: str) -> Array:
        return self.values[quantity]


@dataclass(repr=False)
class Contacts(Shown):
    """Contacts in order of time. A simulation step may have several contacts or none."""

    time_ns: Array = _none("i8")  #: (C,) int64
    point: Array = _none("f8", 3)  #: (C, 3), m, W
    normal: Array = _none("f8", 3)  #: (C, 3), W, into the robot
    slip_velocity: Array = _none("f8", 3)  #: (C, 3), m/s, W, tangential velocity of the robot's point in contact
    normal_force_n: Array = _none("f8")  #: (C,)
    surface_id: Array = _none("i4")  #: (C,) int32, index into Truth.surfaces; -1: unknown

    def __len__(self) -> int:
        return len(self.time_ns)


@dataclass(repr=False)
class Truth(Shown):
    """Ground truth in steps of period_ns from time 0.

    The truth of a real recording contains the measurements of a reference instrument, with NaN at times without a measurement.
    """

    period_ns: int
    position: Array  #: (N, 3), m: centre of mass in W
    quaternion: Array  #: (N, 4), x y z w, body to world
    velocity: Array  #: (N, 3), m/s
    rate: Array  #: (N, 3), rad/s, of the body in W, body axes
    label: Array = _none("u1")  #: (N,) uint8: 0 air, 1 grip, 2 slip, 3 slide; no rows if unknown
    p_BG_m: Array = field(default_factory=lambda: np.zeros(3))  #: (3,), geometric centre in body axes
    imus: list[ImuTruth] = field(default_factory=list)  #: one for each IMU of the recording
    lidars: list[LidarTruth] = field(default_factory=list)  #: one for each lidar
    specific_force: Array = _none("f8", 3)  #: (N, 3), m/s^2, at the centre of mass, body axes; no rows if unknown
    contacts: Contacts = field(default_factory=Contacts)
    surfaces: list[str] = field(default_factory=list)  #: names of surfaces, indexed by surface_id
    series: list[SeriesTruth] = field(default_factory=list)  #: one for each series

    @property
    def time_ns(self) -> Array:
        """(N,) int64."""
        return np.arange(len(self.position), dtype=np.int64) * self.period_ns

    @property
    def imu_rate(self) -> list[Array]:
        """Returns per IMU (M, 3), rad/s: exact mean rate over the window of each sample, IMU axes."""
        return [imu.rate for imu in self.imus]

    @property
    def imu_T_BI(self) -> list[Array]:
        """Returns per IMU (4, 4): its true pose in body axes."""
        return [imu.T_BI for imu in self.imus]


@dataclass(frozen=True)
class _Rows:
    """A dataset of the file and its dataclass member. Reading and writing share this list, so that they cover the same datasets."""

    name: str
    member: str
    dtype: str
    unit: str
    columns: str = XYZ
    like: str = ""  #: member, or `sensor`, with the same number of rows; `one` (a vector), `three`; "": any number
    or_none: bool = False  #: it may have no rows, if its values are unknown
    left_out: bool = False  #: the dataset is omitted if the member is None

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of a row."""
        return (len(self.columns.split()),) if self.columns else ()

    def count(self, record: Any, sensor: int | None) -> int | None:
        """Returns the required number of rows; None: any number. sensor: number of samples or points of the sensor, if known."""
        if not self.like or (self.or_none and len(getattr(record, self.member)) == 0):
            return len(getattr(record, self.member))
        fixed = {"one": 1, "three": 3, "sensor": sensor}
        return fixed[self.like] if self.like in fixed else len(getattr(record, self.like))


_BODY = (
    _Rows("p_WB_m", "position", "f8", "m"), _Rows("q_WB", "quaternion", "f8", "1", "x y z w", "position"),
    _Rows("v_WB_m_s", "velocity", "f8", "m/s", XYZ, "position"), _Rows("w_WB_B_rad_s", "rate", "f8", "rad/s", XYZ, "position"),
    _Rows("f_B_m_s2", "specific_force", "f8", "m/s^2", XYZ, "position", or_none=True),
    _Rows("label", "label", "u1", "1", "", "position", or_none=True), _Rows("p_BG_m", "p_BG_m", "f8", "m", XYZ, "one"))
_CONTACTS = (
    _Rows("time_ns", "time_ns", "i8", "ns", ""), _Rows("point_W_m", "point", "f8", "m", XYZ, "time_ns"),
    _Rows("normal_W", "normal", "f8", "1", XYZ, "time_ns"), _Rows("slip_velocity_W_m_s", "slip_velocity", "f8", "m/s", XYZ, "time_ns"),
    _Rows("normal_force_n", "normal_force_n", "f8", "N", "", "time_ns"), _Rows("surface_id", "surface_id", "i4", "1", "", "time_ns"))
_IMU = (
    _Rows("rate_I_rad_s", "rate", "f8", "rad/s", XYZ, "sensor", or_none=True),
    _Rows("specific_force_I_m_s2", "specific_force", "f8", "m/s^2", XYZ, "rate", or_none=True),
    _Rows("gyro_unclipped_I_rad_s", "gyro_unclipped", "f8", "rad/s", XYZ, "specific_force"),
    _Rows("accel_unclipped_I_m_s2", "accel_unclipped", "f8", "m/s^2", XYZ, "specific_force"),
    _Rows("gyro_bias_I_rad_s", "gyro_bias", "f8", "rad/s", XYZ, "specific_force"),
    _Rows("accel_bias_I_m_s2", "accel_bias", "f8", "m/s^2", XYZ, "specific_force"),
    _Rows("gyro_elements_I", "gyro_elements", "f8", "1", XYZ, "three", left_out=True),
    _Rows("gyro_element_offset_rad_s", "gyro_element_offset_rad_s", "f8", "rad/s", XYZ, "one", left_out=True),
    _Rows("accel_elements_I", "accel_elements", "f8", "1", XYZ, "three", left_out=True),
    _Rows("accel_element_offset_m_s2", "accel_element_offset_m_s2", "f8", "m/s^2", XYZ, "one", left_out=True),
    _Rows("magnetic_field_I_t", "magnetic_field_t", "f8", "T", XYZ, "rate", left_out=True))
_LIDAR = (_Rows("hit_W_m", "hit", "f4", "m", XYZ, "sensor", or_none=True), _Rows("surface_id", "surface_id", "i4", "1", "", "hit"))


def _read_rows(group: Group, listed: Sequence[_Rows], kind: type, **members: Any) -> Any:
    for each in listed:
        rows = group.rows(each.name, each.dtype, each.shape, each.left_out)
        members[each.member] = rows[0] if each.like == "one" and rows is not None and len(rows) == 1 else rows
    record = kind(**members)
    for each in listed:
        rows, count = members[each.member], each.count(record, None)
        found = None if rows is None else 1 if each.like == "one" and rows.ndim == 1 else len(rows)
        if None not in (found, count) and found != count:
            place = f"{group.place}/{each.name}"
            raise TumbleError(f"{place} has {found} rows; it must have {count}", "file", place, found, count)
    return record


def _write_rows(group: Any, listed: Sequence[_Rows], record: Any, sensor: int | None = None) -> None:
    for each in listed:
        rows = getattr(record, each.member)
        if rows is None and each.left_out:
            continue
        rows = np.asarray(rows)[None] if each.like == "one" else np.atleast_1d(rows)
        count = each.count(record, sensor)
        assert count is not None, "datasets with one row per sample need the number of samples"
        put(group, each.name, rows, each.dtype, each.unit, (count, *each.shape), each.columns, many=each.like not in ("one", "three"))


def require_quantity(place: str, name: str) -> None:
    """Raises TumbleError `out_of_range` if `name` is empty or has a character other than letters, digits and _."""
    if not (isinstance(name, str) and name.isascii() and name.replace("_", "a").isalnum()):
        raise TumbleError(f"{place} has a quantity {name!r}; its name must contain only letters, digits and _", "out_of_range", place, name, "a-z A-Z 0-9 _")


def _read_series(group: Group) -> SeriesTruth:
    quantities = {each.attribute("name", str): each for each in group.members("quantities")}
    return SeriesTruth(name=group.attribute("name", str), T_BX=group.rows("T_BX", "f8", (4,)),
                       values={name: each.rows("values", "f8") for name, each in quantities.items()},
                       units={name: each.attribute("unit", str) for name, each in quantities.items()})


def _write_series(group: Any, series: SeriesTruth, samples: int, place: str) -> None:
    group.attrs["name"] = series.name
    put(group, "T_BX", series.T_BX, "<f8", "1, last column m", (4, 4), many=False)
    quantities = group.create_group("quantities")
    for k, (name, values) in enumerate(series.values.items()):
        require_quantity(f"{place}.values", name)
        own, unit = quantities.create_group(str(k)), series.units.get(name, "")
        own.attrs["name"], own.attrs["unit"] = name, unit
        put(own, "values", values, "<f8", unit, (samples if len(values) > 0 else 0,))


def read_truth(group: Group) -> Truth:
    """Reads the group `truth`."""
    imus = [_read_rows(each, _IMU, ImuTruth, name=each.attribute("name", str), T_BI=each.rows("T_BI", "f8", (4,)))
            for each in group.members("imus")]
    lidars = [_read_rows(each, _LIDAR, LidarTruth, name=each.attribute("name", str), T_BL=each.rows("T_BL", "f8", (4,)))
              for each in group.members("lidars")]
    out: Truth = _read_rows(group, _BODY, Truth, period_ns=group.attribute("period_ns", int), imus=imus, lidars=lidars,
                             series=[_read_series(each) for each in group.members("series")],
                             contacts=_read_rows(group.member("contacts"), _CONTACTS, Contacts), surfaces=group.texts("surfaces"))
    return out


def write_truth(group: Any, truth: Truth, samples: Sequence[int], points: Sequence[int], readings: Sequence[int] = ()) -> None:
    """Writes the group `truth`.

    samples, points, readings: number of rows of each IMU, lidar and series of the recording. Raises TumbleError `shape`, `type` or
    `out_of_range`, as for the sensors.
    """
    for name, records, counts in (("imus", truth.imus, samples), ("lidars", truth.lidars, points), ("series", truth.series, readings)):
        if len(records) != len(counts):
            raise TumbleError(f"truth.{name} has {len(records)} entries; it must have {len(counts)}, one for each sensor of the recording", "shape",
                              f"truth.{name}", len(records), len(counts))
    group.attrs["period_ns"] = np.int64(truth.period_ns)
    _write_rows(group, _BODY, truth)
    put_texts(group, "surfaces", truth.surfaces)
    _write_rows(group.create_group("contacts"), _CONTACTS, truth.contacts)
    imus, lidars = group.create_group("imus"), group.create_group("lidars")
    for k, imu in enumerate(truth.imus):
        own = imus.create_group(str(k))
        own.attrs["name"] = imu.name
        put(own, "T_BI", imu.T_BI, "<f8", "1, last column m", (4, 4), many=False)
        _write_rows(own, _IMU, imu, samples[k])
    for k, lidar in enumerate(truth.lidars):
        own = lidars.create_group(str(k))
        own.attrs["name"] = lidar.name
        put(own, "T_BL", lidar.T_BL, "<f8", "1, last column m", (4, 4), many=False)
        _write_rows(own, _LIDAR, lidar, points[k])
    if truth.series:
        others = group.create_group("series")
        for k, series in enumerate(truth.series):
            _write_series(others.create_group(str(k)), series, readings[k], f"truth.series[{k}]")
