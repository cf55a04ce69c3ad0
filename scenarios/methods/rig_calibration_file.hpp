// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <optional>

#include "tumble/angular_velocity/rate_smoother.hpp"

namespace tumble::scenarios {

/// What one run of the smoother learns and the next may start from.
struct LearntRig {
  RigCalibration calibration;
  std::array<std::optional<double>, 6> rail;  ///< gyro x y z [rad/s], accelerometer x y z [m/s^2]; none: not seen
  /// Of the gyro's elements whose rail was seen as a plane, where it cuts the element's row: negative and positive
  /// sign. Its slopes are RigConstants::elements. None: not seen, or upright.
  using Planes = std::array<std::array<std::optional<double>, 2>, 3>;
  Planes gyro_planes_rad_s = {};
  /// Likewise of the accelerometer's elements, whose slopes are no constants of the rig: in their order there.
  Planes accelerometer_planes_m_s2 = {};
  Eigen::Matrix<double, 6, 1> accelerometer_elements = Eigen::Matrix<double, 6, 1>::Zero();
  /// What the device makes of the motion: delay, g-sensitivity, scale; none: nothing was learnt of it.
  std::optional<KnownSensorErrors> device_errors = std::nullopt;
  /// The run learnt of rails alone (with_rails), or of a late accelerometer: all else is what was known before it. Not
  /// in the file.
  bool rails_alone = false;

  /// The rails of a triad's elements, for the search of the next run.
  RailPlanes planes(Triad triad = Triad::gyro) const;
  /// Keeps where planes cut their rows, of those that are sure. The slopes that an unsure one has told are doubted: a
  /// few readings, one of which met the rail in a part of its window, make a plane that is not there.
  void keep(const RailPlanes& planes, Triad triad = Triad::gyro);
};

/// What a run has learnt. When the run left its constants at their prior (RateReport::calibration_at_prior) that is
/// what it was given.
LearntRig learnt(const RateReport& report);

/// What was known before a run that had to hold the constants to that, with the rails that it found: levels and slopes
/// of elements whose plane is sure. Levels stay where nothing surer was found, and go where readings contradict them.
/// None: no plane of this run is sure.
std::optional<LearntRig> with_rails(const LearntRig& before, const KnownRails& rails);

/// Gives it to the next run: constants with their covariance times `trust` (>= 1: rigs are taken apart and put together
/// again), the planes of the gyro's rails, the device's errors likewise, and the lowest rail of a sensor as its stated
/// range. Throws std::invalid_argument on `trust` below 1.
void start_from(const LearntRig& rig, double trust, RateSmoother::Params& params);

/// JSON, a few lines: lever arm, biases, inertia, the gyro's elements, covariance row by row, rails; planes of the
/// rails of gyro and accelerometer; the device's errors in the order of SensorErrors and their covariance. Numbers come
/// back to the bit. Throws BadInput when it cannot write; nothing is left half written.
void write_learnt_rig(const std::filesystem::path& path, const LearntRig& rig);

/// A file from before the elements were learnt lacks them and their six rows: they are what is assumed without any; one
/// from before the accelerometer's planes or the device's errors were lacks those.
/// Throws BadInput with path and key on a missing, misspelt or extra key, on a number that is none or of the wrong
/// count, and on a covariance that is not symmetric and positive definite.
LearntRig read_learnt_rig(const std::filesystem::path& path);

}  // namespace tumble::scenarios
