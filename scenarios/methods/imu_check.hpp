// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "scenarios/methods/frozen_axes.hpp"
#include "scenarios/methods/method.hpp"
#include "scenarios/methods/sphere_imus.hpp"
#include "tumble/common/imu.hpp"

/// Checks the physical plausibility of IMU readings: units, axes, signs, frozen sensors.
namespace tumble::scenarios {

/// Checks the readings and adds the results to the estimate's health and failed checks. The health keys are
/// `imu_force_share`, `imu_rest_force_share`, `imu_rotation_unexplained`, `imu_rotation_slope`,
/// `imu_rotation_agreement`, `imu_frozen_s`, `imu_stamps_rounded_s`, `imu_implausible` and `rate_unit_suspect`. Returns
/// `out_of_range`, with the reason, if readings contradict each other or gravity. O(N).
Status check_imu(const sim::Sensors& sensors, std::span<const ImuSample> samples, Estimate& estimate);

/// Checks several merged IMUs. The differences between the IMUs also reveal a flipped sign (`imu_arm_share`) and
/// permuted axes (`imu_other_axes_share`).
Status check_imus(const sim::Sensors& sensors, const MergedImus& imus, Estimate& estimate);

/// Checks the primary IMU of a rig. The estimate must contain one rate per sample. The function also checks the rates
/// against gravity between rests (check_rotation_between_rests) and about pivots (check_rotation_about_pivots). Returns
/// false if a check failed. The checks use the whole recording. O(N).
bool check_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples, std::optional<double> carried_share,
                 Estimate& estimate);

/// Increases the covariance of every rate by the squared rate and reports `imu_rates_doubted`. A flipped sign gives an
/// error of twice the rate; a scale of one half gives an error of half the rate. Only batch methods may call this
/// function, because the results of a live or lagged method must not depend on later readings.
void inflate_rates(Estimate& estimate);

/// Checks that `rates` rotate gravity correctly from each rest to the next rest (RestGravity). `rates` has one entry
/// per sample. Reports `rest_gravity_missed_rad` with its standard deviation, `rest_velocity_share` with its limit, and
/// `imu_implausible`. O(N).
Status check_rotation_between_rests(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                                    std::span<const RateState> rates, Estimate& estimate);

/// Checks that a body rotating about a pivot turns as `rates` state (PivotCheck). `rates` has one entry per sample. The
/// check only uses rates whose source is `measured`. The pivot check reports the log-likelihood ratio of another
/// interpretation of the gyro (`pivot_evidence`) with the number of segments. The pivot check also reports the
/// best-fitting scale (`pivot_scale`) with its standard deviation, and `imu_implausible`. The cost is proportional to
/// the number of samples, about 1 ms per second of data at 100 Hz.
Status check_rotation_about_pivots(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                                   std::span<const RateState> rates, Estimate& estimate);

/// Checks whether specific forces in a rig's flights contradict the lever arm, axes or signs of the sensor
/// (FlightSense). Reports `imu_implausible` and the affected duration `imu_flight_against_s`. `carried_share` is the
/// fraction of hand-held samples. If `carried_share` shows that the body was never hand-held, the check also reports
/// flipped and swapped axes of gyro and accelerometer. In this case, the check also uses flights with a clipped axis.
/// O(N).
Status check_flights(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                     std::optional<double> carried_share, Estimate& estimate);

/// Returns the frozen axes of the primary IMU. Reports them as `imu_implausible`, and their start as
/// `imu_gyro_z_frozen_since_s`. O(N).
std::vector<FrozenAxis> report_frozen_axes(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                                           Estimate& estimate);

/// Increases the covariance of rates while their gyro axis is frozen. While an axis is frozen, only the largest reading
/// of the recording limits the true rate. Like inflate_rates(), the function is only for batch methods. O(N).
void inflate_frozen_rates(std::span<const FrozenAxis> frozen, std::span<const ImuSample> samples, Estimate& estimate);

}  // namespace tumble::scenarios
