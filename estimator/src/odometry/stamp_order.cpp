// SPDX-License-Identifier: BSD-3-Clause
#include "stamp_order.hpp"

#include "tumble/common/detail/sample_check.hpp"

namespace tumble {

Status StampOrder::order_of_stamp(TimeNs stamp_ns, State& state, Verdict& verdict) const {
  verdict = Verdict::continues_in_order;
  if (const Status status = check_stamp(stamp_ns, "time_ns"); !status.ok()) return status;
  if (!state.newest_ns) return {};
  const Status status = check_stamp_order(stamp_ns, *state.newest_ns, gap_max_s_);
  if (status.ok()) {
    state.rejected.reset();
    return {};
  }
  const bool gap = status.error_code == ErrorCode::gap;
  if (!state.rejected || !check_stamp_order(stamp_ns, state.rejected->last_ns, gap_max_s_).ok()) {
    state.rejected = RejectedStamps{stamp_ns, stamp_ns};
    return status;
  }
  state.rejected->last_ns = stamp_ns;
  const bool confirmed =
      check_stamp_order(stamp_ns, state.rejected->first_ns, kStepBack_s).error_code == ErrorCode::gap;
  if (!gap && !state.only_one_sample && !confirmed) return status;
  verdict = gap ? Verdict::restarts_after_gap : Verdict::restarts_after_step_back;
  return {};
}

void StampOrder::accept(TimeNs stamp_ns, State& state) {
  state = {.newest_ns = stamp_ns, .only_one_sample = !state.newest_ns, .rejected = std::nullopt};
}

}  // namespace tumble
