// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "tumble/common/types.hpp"

namespace tumble {

/// Rejects up to five consecutive outliers among the readings of an IMU, as caused by bus faults. Outliers are far from
/// the readings before and after them, without a change of the other sensor (gyro or accelerometer): outliers.md (O1)
/// to (O6).
///
/// The filter delays an unexplained jump until the readings return, confirm the jump, or five samples are delayed. All
/// other readings pass without delay, unchanged. OutlierFilter does not detect outliers during a hard impact. Cost:
/// O(1) per reading, no allocation.
class OutlierFilter {
 public:
  /// implausible readings of a robot's IMU (57 000 deg/s, 10 000 g), which never pass
  static constexpr double kRateMax_rad_s = 1000.0, kForceMax_m_s2 = 1e5;
  static constexpr std::size_t kDelayedMax = 5;  ///< longest sequence of outliers that is detected
  /// maximum reading of a device, as a multiple of the range in its data sheet
  static constexpr double kMaxReadingToRangeRatio = 2.0;

  /// properties of the IMU from its data sheet; 0: unknown
  struct ImuRanges {
    double gyro_range_rad_s = 0.0;
    double accel_range_m_s2 = 0.0;
    double period_s = 0.0;   ///< nominal time between samples; a sample after 1.75 periods is delayed
    double gap_max_s = 1.0;  ///< a sample after a longer gap is not delayed
  };

  struct State {
    std::array<ImuSample, 2> recent_inliers{};  ///< last samples that passed; the newest is last
    std::size_t count = 0;                      ///< samples that passed since the start, at most 3
    std::array<ImuSample, kDelayedMax> delayed_sample{};
    std::size_t delayed_count = 0;  ///< number of valid samples in `delayed`
    std::size_t rejected = 0;       ///< number of samples rejected since the start

    std::span<const ImuSample> delayed_samples() const { return {delayed_sample.data(), delayed_count}; }
  };

  explicit OutlierFilter(const ImuRanges& device) : imu_ranges_(device) {}

  /// Returns the delayed samples if `next` confirms them; empty if they are rejected, remain delayed, or are absent.
  /// The result is valid until the next call of must_delay_for_check(). `next` must be later than all samples that
  /// passed.
  std::span<const ImuSample> filter_sample(const ImuSample& next, State& state) const;

  /// Returns true if the next samples show that the first samples of a run are outliers. The run should then restart
  /// without them. Call first_is_outlier() before filter_sample().
  bool first_is_outlier(const ImuSample& next, const State& state) const;

  /// Returns true if a finite sample must not be used now, because the sample is delayed or implausibly large. Call
  /// filter_sample() before must_delay_for_check().
  bool must_delay_for_check(const ImuSample& sample, State& state) const;

  /// Call mark_accepted() for each sample that filter_sample() returned or for which must_delay_for_check() returned
  /// false.
  static void mark_accepted(const ImuSample& sample, State& state);

  /// Rejects the delayed samples at the end of a run.
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
