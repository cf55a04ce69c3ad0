// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tumble/common/imu.hpp"

namespace tumble {

/// Rejects single outliers among the readings of an IMU. Outliers result from bus faults; a rejected reading counts as
/// missing.
///
/// An outlier is far above or far below two neighbours that agree with each other, and nothing else explains the jump.
/// A change of the force explains a jump of the gyro, and a change of the rate explains a jump of the accelerometer. A
/// reading whose time stamp is later than the next time stamp is also an outlier. The equations of OutlierFilter are
/// outliers.md (O1) to (O6).
///
/// The filter delays an unexplained jump by one sample, until the next reading confirms or refutes the jump. All other
/// readings pass without delay, unchanged. Readings beyond kRateMax_rad_s or kForceMax_m_s2 never pass. If the first
/// reading is an outlier, the reading passes, but the next two readings refute it (first_is_outlier()). Cost: O(1) per
/// reading, no allocation. OutlierFilter does not detect two outliers in a row, or an outlier during a hard impact.
class OutlierFilter {
 public:
  /// No gyro measures rates above kRateMax_rad_s (57 000 deg/s), and no robot's accelerometer measures forces above
  /// kForceMax_m_s2 (10 000 g).
  static constexpr double kRateMax_rad_s = 1000.0, kForceMax_m_s2 = 1e5;
  /// maximum reading of a device, as a multiple of the range in its data sheet
  static constexpr double kStatedRangesMax = 2.0;

  /// properties of the IMU from its data sheet; 0: unknown
  struct Device {
    double gyro_range_rad_s = 0.0;
    double accel_range_m_s2 = 0.0;
    double period_s = 0.0;   ///< nominal time between samples; a sample after 1.75 periods is delayed
    double gap_max_s = 1.0;  ///< a sample after a longer gap is not delayed
  };

  struct State {
    std::array<ImuSample, 2> recent_inliers{};  ///< last samples that passed; the newest is last
    std::size_t count = 0;                      ///< number of valid samples in `recent_inliers`
    std::optional<ImuSample> delayed;
    std::size_t rejected = 0;  ///< number of samples rejected since the start
  };

  explicit OutlierFilter(const Device& device) : device_(device) {}

  /// Compares the delayed sample with `next`, which must be later than all samples that passed. Returns the delayed
  /// sample if `next` confirms it. Returns empty if the delayed sample is rejected, or if no sample was delayed. After
  /// the call, no sample is delayed.
  std::optional<ImuSample> filter_sample(const ImuSample& next, State& state) const;

  /// Returns true if the first sample of a run is an outlier, because the next samples contradict it. The run should
  /// then restart with the second sample. Call first_is_outlier() before filter_sample().
  bool first_is_outlier(const ImuSample& next, const State& state) const {
    return state.count == 1 && state.delayed && jumps(*state.delayed, state) && confirms(next, state);
  }

  /// Returns true if a finite sample must not be used now, because the sample is delayed or implausibly large. Call
  /// filter_sample() before must_delay().
  bool must_delay(const ImuSample& sample, State& state) const;

  /// Call pass() for each sample that filter_sample() returned or for which must_delay() returned false.
  static void pass(const ImuSample& sample, State& state);

  /// No further reading can confirm the delayed sample, so it is rejected.
  static void finish(State& state);

 private:
  bool confirms(const ImuSample& next, const State& state) const {
    return next.time_ns > state.delayed->time_ns && !is_outlier(*state.delayed, next, state);
  }
  double period_s(const State& state) const;
  bool jumps(const ImuSample& sample, const State& state) const;
  bool is_suspicious(const ImuSample& sample, const State& state) const;
  bool is_outlier(const ImuSample& delayed, const ImuSample& after, const State& state) const;

  Device device_;
};

/// Finds the inliers of a recording whose samples are finite and in time order. Cost: O(N). Element k of the result is
/// true if sample k passes.
std::vector<bool> find_inliers(const OutlierFilter& filter, std::span<const ImuSample> samples);

}  // namespace tumble
