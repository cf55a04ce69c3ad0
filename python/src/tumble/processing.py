# SPDX-License-Identifier: BSD-3-Clause
"""Runs estimators over whole recordings, in one call each."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _tumble
from .checks import having
from .errors import TumbleError
from .recordings import Imu, Recording
from .shown import Shown

#: Box in lidar axes whose returns belong to the rig: smallest and largest corner.
RIG_BODY_L = ((-0.5, -0.4, -0.27), (0.5, 0.4, 0.23))


def _require_imu(imu: Any) -> None:
    having("imu", imu, "an Imu such as recording.imus[0]", "samples", "lever_arm_m", "period_ns", "gyro_range_rad_s", "accel_range_m_s2")


def sheet_of(imu: Imu) -> _tumble.ImuDataSheet:
    """Returns the data sheet of an IMU from the recording. If the recording does not state a noise density, the library's default is used."""
    _require_imu(imu)
    numbers = {"gyro_range_rad_s": imu.gyro_range_rad_s, "accel_range_m_s2": imu.accel_range_m_s2}
    period_ns = imu.period_ns or (float(np.median(np.diff(imu.time_ns))) if len(imu) > 1 else 0.0)
    if period_ns > 0:
        numbers["rate_hz"] = 1.0 / (period_ns * 1e-9)
    for name in ("gyro_noise_rad_s_sqrt_hz", "accel_noise_m_s2_sqrt_hz"):
        if getattr(imu, name) > 0.0:
            numbers[name] = getattr(imu, name)
    return _tumble.ImuDataSheet(**numbers)


def rate(imu: Imu, gravity_m_s2: float = 9.80665, live: bool = False, **options: Any) -> _tumble.Rates:
    """Estimates angular velocity through gyro saturation, one per sample, with the IMU's lever arm, ranges and noise from the recording.

    Uses MotionRegimeSmoother. The result equals the program's `rate/tumble` for a recording with one IMU.

    live      uses MotionRegimeStream, which needs only the next 0.2 s of data (lag_s), as the program's `rate/tumble_lag`
    options   keywords of these classes; they override the values of the recording
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
        return _tumble.MotionRegimeSmoother(**(stated | options)).estimate(*imu.samples)[0]
    if imu.period_ns > 0:
        stated["period_s"] = imu.period_ns * 1e-9
    stated |= options
    if "lag_s" not in options and stated.get("period_s", 0.0) > 0.1:
        stated["lag_s"] = 2.0 * stated["period_s"]
    stream = _tumble.MotionRegimeStream(**stated)
    return _tumble.Rates.joined([stream.add_imu(*imu.samples), stream.flush()])


def _require_recording(recording: Any) -> None:
    having("recording", recording, "a Recording", "first_imu", "lidars", "robot", "gravity_m_s2")


@dataclass(repr=False)
class Tumble(Shown):
    """Results of TumblingOdometry for one recording."""

    poses: _tumble.Poses  #: final (smoothed) poses of the IMU, at its samples within sweeps
    sweeps: list[_tumble.SweepResult]  #: results of the sweeps that have poses, in order of registration
    refused: list[str]  #: error messages of the sweeps without poses
    map: _tumble.MapPoints  #: map within mapping_map_radius_m of the sensor
    odometry: _tumble.TumblingOdometry  #: the estimator, with its calibration: body_imu_calibration(), lidar_calibration()


WHOLE_RECORDING = 1e9  # value of lag_s [s] for an estimate of the whole recording


def tumbling_options(recording: Recording, **options: Any) -> dict[str, Any]:
    """Returns the keywords of TumblingOdometry from a recording. `options` override the values of the recording."""
    _require_recording(recording)
    imu = recording.first_imu
    stated: dict[str, Any] = {"imu": sheet_of(imu), "lever_arm_m": imu.lever_arm_m, "T_IL": recording.T_IL,
                              "gravity_m_s2": recording.gravity_m_s2}
    if recording.robot == "rig":
        stated["own_body_L"] = RIG_BODY_L
    return stated | options


def tumbling(recording: Recording, on_sample: Callable[[_tumble.TumblingOdometry], None] | None = None,
             map: _tumble.MapPoints | None = None, **options: Any) -> Tumble:
    """Estimates pose, velocity and map of a tumbling body with the first IMU and the first lidar of a recording.

    The data are added in the order of a live robot: each sample at the end of its window, each sweep after its last point. This is the
    program's method `slam/tumble_lag`. With lag_s=1e9, the call estimates the whole recording at once, as `slam/tumble` does.

    on_sample   function that is called with the odometry after each sample; newest() returns the live pose
    map         map of an earlier run, in which the robot is localised without a start pose (TumblingOdometry.set_prior_map)
    options     keywords of TumblingOdometry; they override the values of the recording
    """
    odometry = _tumble.TumblingOdometry(**tumbling_options(recording, **options))
    if map is not None:
        odometry.set_prior_map(map)
    imu, lidar = recording.imus[0], recording.sweeps
    done: list[_tumble.Sweep] = []
    given = 0
    whole = options.get("lag_s", 0.0) >= WHOLE_RECORDING

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
        if reached == len(imu) and not (whole and sweep.start_ns < imu.time_ns[-1]):
            break  # this sweep extends beyond the last IMU sample
        if reached >= given:
            add_until(min(reached + 1, len(imu)))
        odometry.add_sweep(sweep.start_ns, sweep.end_ns, sweep.position, sweep.offset_ns, sweep.ring, sweep.intensity)
        done += odometry.take_all()
    if given < len(imu):
        add_until(len(imu))
    odometry.finish()
    done += odometry.take_all()
    placed = [sweep.result for sweep in done if sweep.placed]
    if whole:
        final = [result.trajectory for result in placed]
    else:
        final = [*(result.final_poses_of_earlier_sweep for result in placed if len(result.final_poses_of_earlier_sweep) > 0), odometry.window_trajectory()]
    return Tumble(poses=_tumble.Poses.joined(final), sweeps=placed,
                  refused=[sweep.message for sweep in done if not sweep.placed], map=odometry.map(), odometry=odometry)


def rolling(recording: Recording, **options: Any) -> _tumble.RollingPoses:
    """Estimates poses of the centre of a rolling sphere with RollingOdometry: live, or smoothed with lag_s=SECONDS.

    Uses the first four IMUs, except one named imu_reference. All IMUs must have the same sample times.

    options: keywords of RollingOdometry; they override the values of the recording.
    """
    _require_recording(recording)
    imus = [recording.first_imu, *(imu for imu in recording.imus[1:] if imu.name != "imu_reference")][:4]
    for imu in imus[1:]:
        if not np.array_equal(imu.time_ns, imus[0].time_ns):
            raise TumbleError(f"{imu.name}.time_ns differs from {imus[0].name}.time_ns; both must be equal", "time_order", f"{imu.name}.time_ns")
    stated: dict[str, Any] = {"units": [(sheet_of(imu), imu.T_BI) for imu in imus], "radius_m": recording.sphere_radius_m,
                              "gravity_m_s2": recording.gravity_m_s2}
    odometry = _tumble.RollingOdometry(**(stated | options))
    odometry.add_imu(imus[0].time_ns, [imu.gyro for imu in imus], [imu.accel for imu in imus])
    odometry.finish()
    return odometry.take()
