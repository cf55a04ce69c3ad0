// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include "tumble/angular_velocity/detail/rate_smoother.hpp"
#include "tumble/angular_velocity/rate_stream.hpp"

/// The functions in learnt_rig.hpp pass the calibration of a rig from one run to the next run.
namespace tumble {

/// CalibratedRig is the calibration that one run estimates and that a later run may start from.
struct CalibratedRig {
  RigCalibration calibration;
  std::array<std::optional<double>, 6> rail;  ///< limits of gyro [rad/s], accelerometer [m/s^2]; empty: not observed
  /// Intersections of the gyro's saturation planes with the axis of each sensing element, for the negative and the
  /// positive sign. RigConstants::elements contains the cross-axis sensitivities of the planes. An empty value means
  /// that the plane was not observed or is parallel to the axis.
  using Planes = std::array<std::array<std::optional<double>, 2>, 3>;
  Planes gyro_planes_rad_s = {};
  /// Intersections of the accelerometer's saturation planes with the axis of each sensing element. The array
  /// accelerometer_elements contains the cross-axis sensitivities of the accelerometer planes in the same order.
  Planes accelerometer_planes_m_s2 = {};
  Eigen::Matrix<double, 6, 1> accelerometer_elements = Eigen::Matrix<double, 6, 1>::Zero();
  /// Delay, g-sensitivity and scale errors of the device; empty if not estimated.
  std::optional<KnownSensorErrors> device_errors = std::nullopt;
  /// True if the run estimated only saturation limits (calibration_with_rails) or an accelerometer delay. All other
  /// values are then the prior. The flag is not saved.
  bool only_rails = false;

  /// Returns the saturation planes of the gyro or accelerometer, for saturation detection in the next run.
  RailPlanes planes(Triad triad = Triad::gyro) const;
  /// Stores in this calibration the intersections of all certain saturation planes. The function discards the
  /// cross-axis sensitivities of uncertain planes, because a few partly clipped readings can suggest a wrong plane.
  void keep(const RailPlanes& planes, Triad triad = Triad::gyro);
};

/// Returns the calibration from the report of a run. If RateReport::calibration_at_prior is set, this calibration is
/// the prior.
CalibratedRig learnt(const RateReport& report);

/// Returns the calibration `before`, updated by the certain saturation limits of a run that could not estimate the rig
/// constants. The function replaces old limits only if the run found better limits, and removes limits that readings
/// contradict. Returns empty if no saturation plane is certain.
std::optional<CalibratedRig> calibration_with_rails(const CalibratedRig& before, const SaturationLevels& rails);

/// Applies a calibration to the next run: constants, saturation planes of the gyro, and sensor errors. The lowest
/// saturation limit of a sensor becomes the sensor's range. The covariance of the constants is multiplied by `trust`
/// (>= 1), because a rig may be reassembled between runs. Throws std::invalid_argument if `trust` is below 1.
void start_from(const CalibratedRig& rig, double trust, RateSmoother::Params& params);

/// Sets the priors of the next run from a saved calibration. Lever arm and inertia get four times their saved
/// covariance, but at most the default prior. The function also applies the saturation limits. The function ignores
/// saved biases, because biases change at every switch-on. The overload for RateStream also sets the saved sensor
/// errors.
void apply_saved_calibration(const CalibratedRig& rig, RateSmoother::Params& params);
void apply_saved_calibration(const CalibratedRig& rig, RateStream::Params& params);

/// Returns the calibration before a run: `given`, or the prior in `model` if `given` is null.
CalibratedRig prior_rig_calibration(const CalibratedRig* given, const RateModelParams& model);

/// Returns the calibration to save after a run that started from `given` (null: none). If the run did not estimate the
/// constants, the result is `given` or the prior of `model`, with the certain saturation limits of the run. Returns
/// empty if the run estimated neither constants nor saturation limits.
std::optional<CalibratedRig> learnt(const RateReport& report, const CalibratedRig* given, const RateModelParams& model);

/// Returns true if a RateStream has not estimated the rig constants since its start or its last reset.
bool is_at_prior(const RateStream& stream, const RateStream::State& state);
/// Returns the calibration to save after a run of a RateStream. The delay is the only sensor error that RateStream
/// estimates.
std::optional<CalibratedRig> learnt(const RateStream& stream, const RateStream::Params& params,
                                    const CalibratedRig* given, const RateStream::State& state);

/// Returns the distance between two calibrations: the larger of the Mahalanobis distances of lever arm and inertia,
/// each divided by the square root of its dimension. In 18 pairs of runs on an unchanged rig, the distance was 0.14 to
/// 1.0. An inertia error of 30 % gave a distance of at least 2.3. The covariance of `before` is multiplied by four, as
/// in apply_saved_calibration().
double calibration_distance(const RigCalibration& before, const RigCalibration& now);

}  // namespace tumble
