# SPDX-License-Identifier: BSD-3-Clause
"""Whole recordings through the estimators, in one call each."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _tumble
from .checks import having
from .errors import TumbleError
from .recordings import Imu, Recording

#: The box of the rig's own returns, in axes of its lidar.
RIG_BODY_L = ((-0.5, -0.4, -0.27), (0.5, 0.4, 0.23))


def _require_imu(imu: Any) -> None:
    having("imu", imu, "an Imu, as recording.imus[0]", "samples", "lever_arm_m", "period_ns", "gyro_range_rad_s", "accel_range_m_s2")


def sheet_of(imu: Imu) -> _tumble.ImuSheet:
    """What a recording states of an IMU; where it says nothing of a noise the library's number stands."""
    _require_imu(imu)
    numbers = {"gyro_range_rad_s": imu.gyro_range_rad_s, "accel_range_m_s2": imu.accel_range_m_s2}
    period_ns = imu.period_ns or (float(np.median(np.diff(imu.time_ns))) if len(imu) > 1 else 0.0)
    if period_ns > 0:
        numbers["rate_hz"] = 1.0 / (period_ns * 1e-9)
    for name in ("gyro_noise_rad_s_sqrt_hz", "accel_noise_m_s2_sqrt_hz"):
        if getattr(imu, name) > 0.0:
            numbers[name] = getattr(imu, name)
    return _tumble.ImuSheet(**numbers)


def rate(imu: Imu, gravity_m_s2: float = 9.80665, live: bool = False, **options: Any) -> _tumble.Rates:
    """Angular velocity through saturation, one per sample of a recording, with what the recording states of its IMU (lever arm,
    ranges, noise): RegimeSmoother, as the program's `rate/tumble` of a recording with one IMU.

    live      RegimeStream instead, which looks 0.2 s ahead (lag_s) and not over the whole: `rate/tumble_lag`
    options   keywords of these; they count before what the recording states
    """
    _require_imu(imu)
    stated: dict[str, Any] = {
        "lever_arm_m": imu.lever_arm_m, "gyro_range_rad_s": imu.gyro_range_rad_s or None,
        "accel_range_m_s2": imu.accel_range_m_s2 or None, "evidence_gravity_m_s2": gravity_m_s2, "carried_gravity_m_s2": gravity_m_s2}
    if imu.gyro_noise_rad_s_sqrt_hz > 0.0:
        stated["gyro_noise_density"] = imu.gyro_noise_rad_s_sqrt_hz
    if imu.accel_noise_m_s2_sqrt_hz > 0.0:
        stated["accel_noise_density"] = imu.accel_noise_m_s2_sqrt_hz
    if not live:
        return _tumble.RegimeSmoother(**(stated | options)).estimate(*imu.samples)[0]
    if imu.period_ns > 0:
        stated["period_s"] = imu.period_ns * 1e-9
    stated |= options
    if "lag_s" not in options and stated.get("period_s", 0.0) > 0.1:
        stated["lag_s"] = 2.0 * stated["period_s"]
    stream = _tumble.RegimeStream(**stated)
    return _tumble.Rates.joined([stream.add_imu(*imu.samples), stream.flush()])


def _require_recording(recording: Any) -> None:
    having("recording", recording, "a Recording", "first_imu", "lidars", "robot", "gravity_m_s2")


@dataclass
class Tumble:
    """A tumble as TumblingOdometry saw it."""

    poses: _tumble.Poses  #: of the IMU, at its samples inside of sweeps: each sweep's last word
    sweeps: list[_tumble.SweepReport]  #: of those that have a place, as they were registered
    refused: list[str]  #: what was wrong with the others
    map: _tumble.MapPoints
    odometry: _tumble.TumblingOdometry  #: what it has learnt: rig(), calibration()


def tumbling_options(recording: Recording, **options: Any) -> dict[str, Any]:
    """Keywords of TumblingOdometry from what a recording states; `options` count before them."""
    _require_recording(recording)
    imu = recording.first_imu
    stated: dict[str, Any] = {"imu": sheet_of(imu), "lever_arm_m": imu.lever_arm_m, "T_IL": recording.T_IL,
                              "gravity_m_s2": recording.gravity_m_s2}
    if recording.robot == "rig":
        stated["own_body_L"] = RIG_BODY_L
    return stated | options


def tumbling(recording: Recording, on_sample: Callable[[_tumble.TumblingOdometry], None] | None = None, **options: Any) -> Tumble:
    """Pose, velocity and map of a body that tumbles, as a robot lives through it: each sample when its window ends, each sweep when
    its last point was fired (the program's `slam/tumble_lag`). The first IMU and the first lidar count.

    on_sample   is called after each sample, with the odometry: newest() has the live pose
    options     keywords of TumblingOdometry; they count before what the recording states
    """
    odometry = _tumble.TumblingOdometry(**tumbling_options(recording, **options))
    imu, lidar = recording.imus[0], recording.sweeps
    done: list[_tumble.Sweep] = []
    given = 0

    def add(samples: slice) -> None:
        flags = None if imu.clip_flags is None else imu.clip_flags[samples]
        odometry.add_imu(imu.time_ns[samples], imu.gyro[samples], imu.accel[samples], flags)

    def add_until(end: int) -> None:
        nonlocal given
        if on_sample is None:
            add(slice(given, end))
            given = end
            return
        while given < end:
            add(slice(given, given + 1))
            given += 1
            on_sample(odometry)

    for sweep in lidar:
        reached = int(np.searchsorted(imu.time_ns, sweep.end_ns, side="left"))
        if reached == len(imu):
            break  # the IMU ends before
        if reached >= given:
            add_until(reached + 1)
        odometry.add_sweep(sweep.start_ns, sweep.end_ns, sweep.position, sweep.offset_ns, sweep.ring, sweep.intensity)
        done += odometry.take_all()
    if given < len(imu):
        add_until(len(imu))
    odometry.finish()
    done += odometry.take_all()
    placed = [sweep.report for sweep in done if sweep.placed]
    words = [report.smoothed for report in placed if len(report.smoothed) > 0]
    return Tumble(poses=_tumble.Poses.joined([*words, odometry.window_trajectory()]), sweeps=placed,
                  refused=[sweep.message for sweep in done if not sweep.placed], map=odometry.map(), odometry=odometry)


def rolling(recording: Recording, **options: Any) -> _tumble.RollingPoses:
    """Poses of a rolling sphere's centre from all its IMUs (but one named imu_reference), with RollingOdometry: live ones, or with
    lag_s=SECONDS smoothed with what follows. All IMUs have to be read at the same times.

    options: keywords of RollingOdometry; they count before what the recording states.
    """
    _require_recording(recording)
    imus = [recording.first_imu, *(imu for imu in recording.imus[1:] if imu.name != "imu_reference")][:4]
    for imu in imus[1:]:
        if not np.array_equal(imu.time_ns, imus[0].time_ns):
            raise TumbleError(f"{imu.name}.time_ns is not that of {imus[0].name}, must be the same", "time_order", f"{imu.name}.time_ns")
    stated: dict[str, Any] = {"units": [(sheet_of(imu), imu.T_BI) for imu in imus], "radius_m": recording.sphere_radius_m,
                              "gravity_m_s2": recording.gravity_m_s2}
    odometry = _tumble.RollingOdometry(**(stated | options))
    odometry.add_imu(imus[0].time_ns, [imu.gyro for imu in imus], [imu.accel for imu in imus])
    odometry.finish()
    return odometry.take()
