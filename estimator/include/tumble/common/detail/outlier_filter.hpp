// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "tumble/common/types.hpp"

namespace tumble {

/// Rejects up to five consecutive outliers among the readings of an IMU, as caused by bus faults. Outliers differ from
/// the readings before and after, while the other sensor (gyro or accelerometer) shows no change: outliers.md (O1) to
/// (O6).
///
/// After a jump of one sensor alone, the filter delays samples until later readings decide, but at most five samples.
/// All other samples pass without delay. OutlierFilter does not detect outliers during a hard impact. Cost: O(1) per
/// reading, no allocation.
class OutlierFilter {
 public:
  /// larger readings never pass (57 000 deg/s, 10 000 g)
  static constexpr double kRateMax_rad_s = 1000.0, kForceMax_m_s2 = 1e5;
  static constexpr std::size_t kDelayedMax = 5;
  /// maximum reading, as a multiple of the range in the data sheet
  static constexpr double kMaxReadingToRangeRatio = 2.0;

  /// Ranges of the IMU from its data sheet; 0: unknown.
  struct ImuRanges {
    double gyro_range_rad_s = 0.0;
    double accel_range_m_s2 = 0.0;
    double period_s = 0.0;   ///< nominal time between samples; a sample later than 1.75 periods is delayed
    double gap_max_s = 1.0;  ///< a sample after a longer gap is not delayed
  };

  struct State {
    std::array<ImuSample, 2> recent_inliers{};  ///< last samples that passed, oldest first
    std::size_t count = 0;                      ///< samples that passed since the start, at most 3
    std::array<ImuSample, kDelayedMax> delayed_sample{};
    std::size_t delayed_count = 0;
    std::size_t rejected = 0;

    std::span<const ImuSample> delayed_samples() const { return {delayed_sample.data(), delayed_count}; }
  };

  explicit OutlierFilter(const ImuRanges& device) : imu_ranges_(device) {}

  /// Returns the delayed samples if `next` confirms that they are correct; otherwise returns an empty list. The result
  /// is valid until the next call of must_delay_for_check(). `next` must be later than all samples that passed.
  std::span<const ImuSample> filter_sample(const ImuSample& next, State& state) const;

  /// Returns true if `next` and earlier samples show that the first samples of a run are outliers. The run should then
  /// restart without these outliers. Call first_is_outlier() before filter_sample().
  bool first_is_outlier(const ImuSample& next, const State& state) const;

  /// Returns true if a finite sample must not be used yet (delayed), or not at all (implausibly large). Call
  /// filter_sample() before must_delay_for_check().
  bool must_delay_for_check(const ImuSample& sample, State& state) const;

  /// Call mark_accepted() for each sample that filter_sample() returned or for which must_delay_for_check() returned
  /// false.
  static void mark_accepted(const ImuSample& sample, State& state);

  /// Rejects the delayed samples. Call finish() at the end of a run.
  static void finish(State& state);

 private:
  enum class Verdict { rejected, delayed, confirmed };
  Verdict judge(const ImuSample& next, const State& state) const;
  bool is_implausible(const ImuSample& sample) const;
  double period_s(const State& state) const;
  bool jumps(const ImuSample& sample, std::span<const ImuSample> delayed_sample, const State& state) const;
  bool is_outlier_candidate(const ImuSample& sample, const State& state) const;
  bool is_outlier(std::size_t delayed, const ImuSample& after, const State& state) const;

  ImuRanges imu_ranges_;
};

/// Element k of the result is true if sample k passes. The samples must be finite and in time order. Cost: O(N).
std::vector<bool> find_inliers(const OutlierFilter& filter, std::span<const ImuSample> samples);

}  // namespace tumble
