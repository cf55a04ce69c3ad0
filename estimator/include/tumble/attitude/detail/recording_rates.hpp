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

/// Returns `ok`, or an error of align() or RegimeSmoother::estimate().
Status estimate_rates(std::span<const ImuSample> samples, std::span<const AuxiliaryRecording> auxiliary_imus,
                      const RegimeSmoother::Params& params, std::vector<RateState>& rates,
                      RegimeSmoother::Report& report);

/// Recording with replaced gyro readings, for methods that need gyro readings instead of rates.
struct RecoveredRates {
  std::vector<ImuSample> samples;  ///< the recording with replaced gyro readings
  std::vector<Eigen::Matrix3d>
      covariances_rad2_s2;          ///< one covariance per sample, in sensor axes; zero for unmodified readings
  std::vector<RateSource> sources;  ///< one per sample; all `measured` if no rate was estimated
  bool estimated = false;           ///< a reading clips, and RegimeSmoother estimated the rates
  std::size_t replaced = 0;         ///< number of clipped or suspect readings that were replaced
  RegimeSmoother::Report report;    ///< valid if `estimated`
  SaturationLevels rails;
};

enum class ReplacedReadings : std::uint8_t {
  clipped,  ///< readings with a clipped axis
  /// readings with a clipped or suspect axis; all readings if the gyro updates more slowly than the log
  unreliable,
};

/// Replaces clipped gyro readings by estimated rates plus the gyro bias, so that replaced and original readings have
/// equal bias. All three axes of a reading are replaced, because a tilted plane of saturated readings also corrupts the
/// unclipped axes. If no reading clips or the estimation fails, all readings remain. With `unreliable`, the readings of
/// a gyro that updates more slowly than the log are still interpolated. Cost: O(N).
RecoveredRates recover_rates(std::span<const ImuSample> samples, std::span<const AuxiliaryRecording> auxiliary_imus,
                             const RegimeSmoother::Params& params, ReplacedReadings replaced);

}  // namespace tumble
