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

/// The functions in recording_rates.hpp estimate the rates of a whole recording, and replace gyro readings by the
/// estimated rates.
namespace tumble {

/// Estimates the rates of a recording with RegimeSmoother and additional IMUs. Returns `ok`, or an error of align() or
/// RegimeSmoother::estimate().
Status estimate_rates(std::span<const ImuSample> samples, std::span<const AuxiliaryRecording> auxiliary_imus,
                      const RegimeSmoother::Params& params, std::vector<RateState>& rates,
                      RegimeSmoother::Report& report);

/// RecoveredRates contains a recording with replaced gyro readings, for methods that need gyro readings instead of
/// rates.
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

/// ReplacedReadings selects the gyro readings that recover_rates() replaces.
enum class ReplacedReadings : std::uint8_t {
  clipped,  ///< readings with a clipped axis
  /// Readings with a clipped or suspect axis. If the gyro updates more slowly than the log, recover_rates() replaces
  /// all readings, because RateSmoother removes the gyro's delay. Smoothers with their own motion model perform better
  /// with `clipped`.
  unreliable,
};

/// Replaces all three axes of readings by estimated rates, because a tilted saturation plane also corrupts the
/// unclipped axes. The function adds the gyro bias to the replaced readings, so that replaced and original readings
/// have equal bias. If no reading clips or the estimation fails, the function keeps all readings. With `unreliable`,
/// the function still interpolates the readings of a gyro that updates more slowly than the log. Cost: O(N).
RecoveredRates recover_rates(std::span<const ImuSample> samples, std::span<const AuxiliaryRecording> auxiliary_imus,
                             const RegimeSmoother::Params& params, ReplacedReadings replaced);

}  // namespace tumble
