// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <optional>

#include "tumble/angular_velocity/rate_smoother.hpp"

namespace tumble::scenarios {

/// Calibration that a run of the smoother estimates and a later run may start from.
struct LearntRig {
  RigCalibration calibration;
  std::array<std::optional<double>, 6> rail;  ///< saturation limits of gyro x y z [rad/s], accelerometer x y z [m/s^2];
                                              ///< empty: not observed
  /// Intercepts of the gyro elements' saturation planes on the element's axis: negative and positive sign. The slopes
  /// are in RigConstants::elements. Empty: not observed, or perpendicular to the axis.
  using Planes = std::array<std::array<std::optional<double>, 2>, 3>;
  Planes gyro_planes_rad_s = {};
  /// Same for the accelerometer's elements. Their slopes are not rig constants and are stored here in the same order.
  Planes accelerometer_planes_m_s2 = {};
  Eigen::Matrix<double, 6, 1> accelerometer_elements = Eigen::Matrix<double, 6, 1>::Zero();
  /// Errors of the device: delay, g-sensitivity, scale; empty: not estimated.
  std::optional<KnownSensorErrors> device_errors = std::nullopt;
  /// The run only estimated saturation limits (with_rails) or an accelerometer delay; everything else is the prior. Not
  /// stored in the file.
  bool rails_alone = false;

  /// Returns the saturation planes of a triad, for the detection in the next run.
  RailPlanes planes(Triad triad = Triad::gyro) const;
  /// Stores the intercepts of the certain planes. The slopes of uncertain planes are discarded, because a few partly
  /// clipped readings can suggest a wrong plane.
  void keep(const RailPlanes& planes, Triad triad = Triad::gyro);
};

/// Returns the calibration from a run's report. If the run kept the constants at their prior
/// (RateReport::calibration_at_prior), this is the prior.
LearntRig learnt(const RateReport& report);

/// Returns the calibration `before` with the certain saturation limits of a run that could not estimate the constants.
/// Keeps old levels unless better ones were found; removes levels that readings contradict. Empty if no plane is
/// certain.
std::optional<LearntRig> with_rails(const LearntRig& before, const KnownRails& rails);

/// Applies a calibration to the next run: constants, the gyro's saturation planes, and the device's errors. The lowest
/// saturation limit of a sensor becomes its range. The covariance of the constants is multiplied by `trust` (>= 1),
/// because rigs are reassembled. Throws std::invalid_argument if `trust` is below 1.
void start_from(const LearntRig& rig, double trust, RateSmoother::Params& params);

/// Writes a short JSON file. It contains lever arm, biases, inertia and gyro elements with their covariance (by rows),
/// and saturation limits and planes of both triads. It also contains the device's errors in the order of SensorErrors,
/// with covariance. Numbers round-trip bit-exactly. Throws BadInput if writing fails, and then leaves no partial file.
void write_learnt_rig(const std::filesystem::path& path, const LearntRig& rig);

/// Reads a calibration file. Files of earlier versions may lack the gyro elements and their six covariance rows,
/// accelerometer planes or device errors; defaults replace them.
/// Throws BadInput with path and key for a missing, misspelt or extra key, an invalid number, or a wrong count. Also
/// throws if a covariance is not symmetric positive definite.
LearntRig read_learnt_rig(const std::filesystem::path& path);

}  // namespace tumble::scenarios
