// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "tumble/attitude/detail/imu_merge.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// first and last time stamp of a series of consecutive rejected time stamps
struct RejectedStamps {
  TimeNs first_ns = 0, last_ns = 0;
};

/// Decides which IMU time stamps continue a run, and when the run restarts because the clock changed. A time stamp that
/// is not later than the last accepted time stamp is rejected with `time_order`. A time stamp more than `gap_max_s`
/// after the last accepted time stamp is rejected with `gap`. After a gap, the run restarts when the next time stamp
/// confirms the rejected time stamp. After a backward step of the clock, the run restarts when rejected time stamps
/// have increased for kStepBack_s. If only one sample was accepted, its time stamp may be wrong, so one further time
/// stamp is enough for a restart. OutlierFilter detects time stamps that are too late by less than `gap_max_s`.
class StampOrder {
 public:
  static constexpr double kStepBack_s = 0.2;

  struct State {
    std::optional<TimeNs> newest_ns;  ///< last accepted time stamp
    bool only_one_sample = false;     ///< only one sample was accepted
    std::optional<RejectedStamps> rejected;
  };
  enum class Verdict { continues_in_order, restarts_after_gap, restarts_after_step_back };

  explicit StampOrder(double gap_max_s) : gap_max_s_(gap_max_s) {}

  /// Returns `out_of_range` (beyond kStampMax_ns), `time_order` or `gap` if the sample must not be used. If the status
  /// is `ok`, `verdict` states whether the run must restart with the sample.
  Status order_of_stamp(TimeNs stamp_ns, State& state, Verdict& verdict) const;

  static void accept(TimeNs stamp_ns, State& state);

 private:
  double gap_max_s_;
};

/// Resamples the readings of several IMUs, each with its own time stamps, to common times.
///
/// The common times are the time stamps of the reference IMU, which is initially the first IMU. If the reference IMU
/// has no reading for kSilentMax_s while another IMU has readings, the next IMU with readings becomes the reference.
/// The readings of all IMUs except the reference IMU are interpolated linearly (ImuInterpolation). An IMU is absent at
/// a common time if the previous or next reading of this IMU is more than kSilentMax_s away. The alignment is causal,
/// and its output is at most kSilentMax_s late. Readings for a common time are returned when each IMU has a reading at
/// or after the common time, or has no reading for kSilentMax_s.
///
/// Cost: O(1) per reading. The stored readings cover kSilentMax_s.
class ImuTimeAlignment {
 public:
  static constexpr double kSilentMax_s = 0.05;
  using Readings = std::array<ImuSample, ImuMerge::kImus>;

  struct State {
    /// stored readings of each IMU, starting with the last reading before the newest common time
    std::array<std::vector<ImuSample>, ImuMerge::kImus> readings;
    std::size_t reference_imu = 0;
    std::optional<TimeNs> first_ns;               ///< first reading of any IMU
    std::optional<TimeNs> newest_common_time_ns;  ///< newest common time
  };

  /// `units` is the number of IMUs, at most ImuMerge::kImus.
  explicit ImuTimeAlignment(std::size_t units) : imu_count_(units) {}

  /// Ignores non-finite readings. If the time stamp is not later than the last time stamp of the IMU, push() returns
  /// `time_order` and does not change the state.
  Status push(std::size_t unit, const ImuSample& sample, State& state) const;

  /// `out` receives the readings of all IMUs at the next common time. The rates of an absent IMU are NaN. Returns false
  /// while an IMU may still send a reading before the next common time. If `ended` is true, next() does not wait for
  /// further readings.
  bool next(State& state, Readings& out, bool ended = false) const;

 private:
  void choose_reference(State& state) const;
  bool is_complete(std::size_t unit, TimeNs time_ns, const State& state) const;

  std::size_t imu_count_;
};

}  // namespace tumble
