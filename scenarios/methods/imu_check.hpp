// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/sphere_imus.hpp"
#include "tumble/common/imu.hpp"

/// Whether readings can be what they claim to be: units, axes, signs, alive, by physics alone.
namespace tumble::scenarios {

/// Puts what was found into the estimate's health and doubts (`imu_force_share`, `imu_rest_force_share`,
/// `imu_rotation_unexplained`, `imu_rotation_slope`, `imu_rotation_agreement`, `imu_frozen_s`, `imu_stamps_rounded_s`,
/// `imu_implausible`, `rate_unit_suspect`) and returns the verdict: `out_of_range` with what was seen, where the
/// readings contradict each other or gravity. O(N).
Status check_imu(const sim::Sensors& sensors, std::span<const ImuSample> samples, Estimate& estimate);

/// The same of several IMUs as one, whose differences tell a flipped sign besides (`imu_arm_share`), and other axes
/// (`imu_other_axes_share`).
Status check_imus(const sim::Sensors& sensors, const MergedImus& imus, Estimate& estimate);

/// The same of a rig's primary IMU whose rates the estimate holds, one for each sample, with what gravity at its rests
/// says of them (check_rotation_between_rests) and what its turning about a point does (check_rotation_about_pivots).
/// Where one of them speaks against the readings, the covariance of every rate grows by the square of the rate
/// (`imu_rates_doubted`). O(N).
void check_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples, std::optional<double> carried_share,
                 Estimate& estimate);

/// Whether `rates`, one for each sample, those of an estimate of rates or what an attitude was turned by, lead gravity
/// from one rest to the next (RestGravity): `rest_gravity_missed_rad` with its deviation, `rest_velocity_share` with
/// its bound, and `imu_implausible`. O(N).
Status check_rotation_between_rests(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                                    std::span<const RateState> rates, Estimate& estimate);

/// Whether a body that is held turns as `rates` say, one for each sample, those of an estimate of rates or what an
/// attitude was turned by (PivotCheck): `pivot_evidence` for another reading of the gyro and from how many segments,
/// `pivot_scale` by which the rates explain most, with its deviation, and `imu_implausible`. Rates that are not
/// `measured` do not count. O(N), a millisecond for a second at 100 Hz.
Status check_rotation_about_pivots(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                                   std::span<const RateState> rates, Estimate& estimate);

/// Whether flights of a rig show forces of another sensor than this at its lever arm (FlightSense): `imu_implausible`
/// and the seconds of it, as `imu_flight_against_s`. Where `carried_share`, of the samples by the regimes of
/// their rates, says that nobody held the body, flipped and swapped axes of both sensors are told, and flights in which
/// an axis clips count. O(N).
Status check_flights(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                     std::optional<double> carried_share, Estimate& estimate);

/// Single axes of the primary IMU that froze, whose samples these are: `imu_implausible`, and since when, as
/// `imu_gyro_z_frozen_since_s`. Of a gyro's axis nothing is known meanwhile but that it turns no faster than any
/// reading of the run: so much is added to the variance of the rates that the estimate holds. O(N).
void tell_frozen_axes(const sim::Sensors& sensors, std::span<const ImuSample> samples, Estimate& estimate);

}  // namespace tumble::scenarios
