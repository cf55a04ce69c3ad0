// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/estimates/estimate_clock.hpp"

#include <optional>

#include "scenarios/recordings/recording_file.hpp"

namespace tumble::scenarios {

namespace {

template <class States>
void shift(States& states, std::int64_t by_ns) {
  for (auto& state : states) state.time_ns += by_ns;
}

std::optional<StampSpan> span_of(const Estimate& estimate) {
  if (!estimate.poses.empty()) return StampSpan{estimate.poses.front().time_ns, estimate.poses.back().time_ns};
  if (!estimate.attitudes.empty())
    return StampSpan{estimate.attitudes.front().time_ns, estimate.attitudes.back().time_ns};
  if (!estimate.rates.empty()) return StampSpan{estimate.rates.front().time_ns, estimate.rates.back().time_ns};
  return std::nullopt;
}

}  // namespace

void move_to_clock(std::int64_t origin_ns, const StampSpan& span, Estimate& estimate) {
  const std::optional<StampSpan> stamps = span_of(estimate);
  if (!stamps) return;
  const std::int64_t by_ns = clock_shift_ns(*stamps, span, {0, -origin_ns, -export_origin_ns(origin_ns)}).value_or(0);
  if (by_ns == 0) return;
  shift(estimate.rates, by_ns);
  shift(estimate.attitudes, by_ns);
  shift(estimate.poses, by_ns);
  for (std::int64_t& end_ns : estimate.sweep_end_ns) end_ns += by_ns;
  for (auto& sweep : estimate.sweeps) {
    sweep.pose.time_ns += by_ns;
    shift(sweep.trajectory, by_ns);
    shift(sweep.final_poses_of_earlier_sweep, by_ns);
  }
}

}  // namespace tumble::scenarios
