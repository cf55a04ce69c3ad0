// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <optional>

#include "tumble/angular_velocity/rate_smoother.hpp"

namespace tumble::scenarios {

/// Calibration that a run of the smoother estimates. A later run may start from this calibration.
struct LearntRig {
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
  /// the prior. The file does not store this flag.
  bool rails_alone = false;

  /// Returns the saturation planes of a triad, for saturation detection in the next run.
  RailPlanes planes(Triad triad = Triad::gyro) const;
  /// Stores the intercepts of the certain planes. The cross-axis sensitivities of uncertain planes are discarded,
  /// because a few partly clipped readings can suggest a wrong plane.
  void keep(const RailPlanes& planes, Triad triad = Triad::gyro);
};

/// Returns the calibration from a run's report. If the run kept the constants at their prior
/// (RateReport::calibration_at_prior), the returned calibration is the prior.
LearntRig learnt(const RateReport& report);

/// Returns the calibration `before`, with the certain saturation levels of a run that could not estimate the constants.
/// Old levels are kept unless the run found better levels. Levels that readings contradict are removed. Returns empty
/// if no plane is certain.
std::optional<LearntRig> with_rails(const LearntRig& before, const SaturationLevels& rails);

/// Applies a calibration to the next run: constants, saturation planes of the gyro, and errors of the device. The
/// lowest saturation level of a sensor becomes the sensor's range. The covariance of the constants is multiplied by
/// `trust` (>= 1), because a rig may be reassembled between runs. Throws std::invalid_argument if `trust` is below 1.
void start_from(const LearntRig& rig, double trust, RateSmoother::Params& params);

/// Writes a calibration as a short JSON file. The file contains lever arm, biases, inertia and gyro sensing elements
/// with their covariance (by rows), and saturation levels and planes of gyro and accelerometer. The file also contains
/// the errors of the device in the order of SensorErrors, with covariance. Reading restores all numbers bit-exactly.
/// Throws BadInput if writing fails; no partial file remains.
void write_learnt_rig(const std::filesystem::path& path, const LearntRig& rig);

/// Reads a calibration file. Files of earlier versions may lack the gyro sensing elements with their six covariance
/// rows, accelerometer planes, or device errors. Defaults replace missing values. Throws BadInput with path and key for
/// a missing, misspelt or extra key, an invalid number, or a wrong count. Throws BadInput also if a covariance is not
/// symmetric positive definite.
LearntRig read_learnt_rig(const std::filesystem::path& path);

}  // namespace tumble::scenarios
