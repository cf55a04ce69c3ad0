// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/auxiliary_recording.hpp"
#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/attitude/detail/regime_smoother.hpp"

namespace tumble {

/// Estimates the rates of a recording with MotionRegimeSmoother, with optional additional IMUs. Returns `ok`, or an
/// error of align() or MotionRegimeSmoother::estimate().
Status estimate_rates(std::span<const ImuSample> samples, std::span<const AuxiliaryRecording> auxiliary_imus,
                      const MotionRegimeSmoother::Params& params, std::vector<AngularRateState>& rates,
                      MotionRegimeSmoother::Report& report);

/// Recording in which estimated rates replace gyro readings, for methods that need gyro readings as input.
struct RecoveredRates {
  std::vector<ImuSample> samples;
  std::vector<Eigen::Matrix3d>
      covariances_rad2_s2;                 ///< one covariance per sample, in sensor axes; zero for unmodified readings
  std::vector<AngularRateSource> sources;  ///< one per sample
  bool estimated = false;                  ///< true if a reading clips, and MotionRegimeSmoother succeeded
  std::size_t replaced_reading_count = 0;  ///< number of clipped or possibly clipped readings that were replaced
  MotionRegimeSmoother::Report report;
  SaturationLevels saturation_levels;
};

enum class ReadingsToReplace : std::uint8_t {
  clipped,
  /// readings with a clipped or possibly clipped axis; all readings if the gyro updates more slowly than the log
  unreliable_readings,
};

/// Replaces clipped gyro readings by estimated rates plus the gyro bias, so that replaced and original readings have
/// equal bias. All three axes of a reading are replaced, because the gyro's misalignment compensation also corrupts the
/// unclipped axes. If no reading clips or the estimation fails, all readings remain. With `unreliable_readings`, the
/// readings of a gyro that updates more slowly than the log are still interpolated. Cost: O(N).
RecoveredRates recover_rates(std::span<const ImuSample> samples, std::span<const AuxiliaryRecording> auxiliary_imus,
                             const MotionRegimeSmoother::Params& params, ReadingsToReplace replaced);

}  // namespace tumble
