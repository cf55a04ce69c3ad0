// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

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

}  // namespace tumble
