// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <optional>

#include "tumble/angular_velocity/rate_smoother.hpp"

namespace tumble::scenarios {

/// Calibration that a run of the smoother estimates and from which a later run may start.
struct LearntRig {
  RigCalibration calibration;
  std::array<std::optional<double>, 6> rail;  ///< saturation limits of gyro x y z [rad/s], accelerometer x y z [m/s^2];
                                              ///< empty: not observed
  /// Intercepts of the saturation planes of the gyro's sensing elements on the element's axis, for the negative and the
  /// positive sign. The cross-axis sensitivities of the planes are in RigConstants::elements. An empty value means that
  /// the plane was not observed or is perpendicular to the axis.
  using Planes = std::array<std::array<std::optional<double>, 2>, 3>;
  Planes gyro_planes_rad_s = {};
  /// Intercepts of the saturation planes of the accelerometer's sensing elements. The cross-axis sensitivities of the
  /// accelerometer planes are not rig constants; they are stored here in the order of the intercepts.
  Planes accelerometer_planes_m_s2 = {};
  Eigen::Matrix<double, 6, 1> accelerometer_elements = Eigen::Matrix<double, 6, 1>::Zero();
  /// Errors of the device: delay, g-sensitivity, scale; empty: not estimated.
  std::optional<KnownSensorErrors> device_errors = std::nullopt;
  /// True if the run only estimated saturation levels (with_rails) or an accelerometer delay; all other values are the
  /// prior. The flag is not stored in the file.
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

/// Returns the calibration `before` with the certain saturation levels of a run that could not estimate the constants.
/// Keeps old levels unless the run found better levels; removes levels that readings contradict. Returns empty if no
/// plane is certain.
std::optional<LearntRig> with_rails(const LearntRig& before, const KnownRails& rails);

/// Applies a calibration to the next run: constants, saturation planes of the gyro, and errors of the device. The
/// lowest saturation level of a sensor becomes the sensor's range. The covariance of the constants is multiplied by
/// `trust` (>= 1), because rigs are reassembled. Throws std::invalid_argument if `trust` is below 1.
void start_from(const LearntRig& rig, double trust, RateSmoother::Params& params);

/// Writes a calibration as a short JSON file. The file contains lever arm, biases, inertia and gyro sensing elements
/// with their covariance (by rows), and saturation levels and planes of both triads. The file also contains the errors
/// of the device in the order of SensorErrors, with covariance. Reading restores all numbers bit-exactly. Throws
/// BadInput if writing fails; no partial file remains.
void write_learnt_rig(const std::filesystem::path& path, const LearntRig& rig);

/// Reads a calibration file. Files of earlier versions may lack the gyro sensing elements and their six covariance
/// rows, accelerometer planes or device errors; defaults replace missing values. Throws BadInput with path and key for
/// a missing, misspelt or extra key, an invalid number, or a wrong count. Also throws BadInput if a covariance is not
/// symmetric positive definite.
LearntRig read_learnt_rig(const std::filesystem::path& path);

}  // namespace tumble::scenarios
