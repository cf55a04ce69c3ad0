// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include "tumble/angular_velocity/rate_smoother.hpp"
#include "tumble/angular_velocity/rate_stream.hpp"

/// learnt_rig.hpp passes the calibration of a rig from one run to the next run.
namespace tumble {

/// Calibration that a run of the smoother estimates. A later run may start from this calibration.
struct CalibratedRig {
  RigCalibration calibration;
  std::array<std::optional<double>, 6> rail;  ///< limits of gyro [rad/s], accelerometer [m/s^2]; empty: not observed
  /// Intercepts of the saturation planes of the gyro's sensing elements on the element's axis, for the negative and the
  /// positive sign. RigConstants::elements contains the cross-axis sensitivities of the planes. An empty value means
  /// that the plane was not observed or is parallel to the axis.
  using Planes = std::array<std::array<std::optional<double>, 2>, 3>;
  Planes gyro_planes_rad_s = {};
  /// Intercepts of the saturation planes of the accelerometer's sensing elements. The cross-axis sensitivities of the
  /// accelerometer planes are not part of RigConstants, so this struct stores them in the order of the intercepts.
  Planes accelerometer_planes_m_s2 = {};
  Eigen::Matrix<double, 6, 1> accelerometer_elements = Eigen::Matrix<double, 6, 1>::Zero();
  /// Delay, g-sensitivity and scale errors of the device; empty if not estimated.
  std::optional<KnownSensorErrors> device_errors = std::nullopt;
  /// True if the run only estimated saturation levels (with_rails) or an accelerometer delay; all other values are then
  /// the prior. A saved calibration does not contain this flag.
  bool rails_alone = false;

  /// Returns the saturation planes of a triad, for saturation detection in the next run.
  RailPlanes planes(Triad triad = Triad::gyro) const;
  /// Stores the intercepts of the certain planes. The cross-axis sensitivities of uncertain planes are discarded,
  /// because a few partly clipped readings can suggest a wrong plane.
  void keep(const RailPlanes& planes, Triad triad = Triad::gyro);
};

/// Returns the calibration from a run's report. If the run kept the constants at their prior
/// (RateReport::calibration_at_prior), the returned calibration is the prior.
CalibratedRig learnt(const RateReport& report);

/// Returns the calibration `before`, with the certain saturation levels of a run that could not estimate the constants.
/// Old levels are kept unless the run found better levels. Levels that readings contradict are removed. Returns empty
/// if no plane is certain.
std::optional<CalibratedRig> with_rails(const CalibratedRig& before, const SaturationLevels& rails);

/// Applies a calibration to the next run: constants, saturation planes of the gyro, and errors of the device. The
/// lowest saturation level of a sensor becomes the sensor's range. The covariance of the constants is multiplied by
/// `trust` (>= 1), because a rig may be reassembled between runs. Throws std::invalid_argument if `trust` is below 1.
void start_from(const CalibratedRig& rig, double trust, RateSmoother::Params& params);

/// Sets the priors of the next run from a saved calibration: lever arm and inertia with four times their covariance,
/// but at most the default prior, and the saturation levels. Saved biases are not used, because biases change at every
/// switch-on. The stream also uses the saved device errors.
void start_from_calibration(const CalibratedRig& rig, RateSmoother::Params& params);
void start_from_calibration(const CalibratedRig& rig, RateStream::Params& params);

/// Returns the calibration before a run: `given`, or the prior in `model` if `given` is null.
CalibratedRig known_before(const CalibratedRig* given, const RateModelParams& model);

/// Returns the calibration to save after a run that started from `given` (null: none). If the run did not estimate the
/// constants, the result is `given` or the prior of `model`, with the certain saturation levels of the run. Returns
/// nothing if the run estimated neither.
std::optional<CalibratedRig> learnt(const RateReport& report, const CalibratedRig* given, const RateModelParams& model);

/// Returns whether a stream has not estimated the rig's constants, or has not estimated them since the last reset.
bool is_at_prior(const RateStream& stream, const RateStream::State& state);
/// Returns the calibration to save after a run of a stream, as for RateSmoother. The delay is the only device error
/// that the stream estimates.
std::optional<CalibratedRig> learnt(const RateStream& stream, const RateStream::Params& params,
                                    const CalibratedRig* given, const RateStream::State& state);

/// Returns the distance between two calibrations: the larger of the Mahalanobis distances of lever arm and inertia,
/// each divided by the square root of the number of unknowns. Two runs on an unchanged rig gave 0.14 to 1.0 in 18
/// pairs. An inertia error of 30 % gave at least 2.3. The covariance of `before` is multiplied by four, as in
/// start_from_calibration().
double distance_of_rigs(const RigCalibration& before, const RigCalibration& now);

}  // namespace tumble
