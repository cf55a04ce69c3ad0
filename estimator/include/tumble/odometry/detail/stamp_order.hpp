// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "tumble/common/status.hpp"
#include "tumble/common/time.hpp"

namespace tumble {

/// First and last of the rejected stamps that follow each other.
struct RejectedStamps {
  TimeNs first_ns = 0, last_ns = 0;
};

/// Decides which IMU stamps continue a run, and when the run restarts because the clock changed. TumblingOdometry and
/// RollingOdometry use the same rules:
/// - A stamp that is not later than the last accepted stamp is rejected with `time_order`.
/// - A stamp more than `gap_max_s` after the last accepted stamp is rejected with `gap`.
/// - The run restarts after a gap when the next stamp confirms the rejected stamp.
/// - The run restarts after the clock stepped back when rejected stamps have increased for kStepBack_s. One confirming
///   stamp is enough if the run consists of one sample, since that sample may have the wrong stamp.
/// A single wrong stamp thus costs one sample. Stamps that are ahead by less than a gap are found by OutlierFilter.
class StampOrder {
 public:
  static constexpr double kStepBack_s = 0.2;

  struct State {
    std::optional<TimeNs> newest_ns;  ///< last accepted stamp
    bool single = false;              ///< only one sample was accepted
    std::optional<RejectedStamps> rejected;
  };
  enum class Verdict { continues, restarts_after_gap, restarts_after_step_back };

  explicit StampOrder(double gap_max_s) : gap_max_s_(gap_max_s) {}

  /// Judges a stamp. On an error, which is `out_of_range` beyond kStampMax_ns, `time_order` or `gap`, the sample must
  /// not be used. Otherwise `verdict` states whether the run must restart with this sample.
  Status classify_stamp(TimeNs stamp_ns, State& state, Verdict& verdict) const;

  /// Records that the sample with this stamp was used.
  static void accept(TimeNs stamp_ns, State& state);

 private:
  double gap_max_s_;
};

}  // namespace tumble
