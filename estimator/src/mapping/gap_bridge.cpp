// SPDX-License-Identifier: BSD-3-Clause
#include "gap_bridge.hpp"

#include <algorithm>

#include "tumble/common/types.hpp"
#include "tumble/mapping/detail/odometry_params.hpp"

namespace tumble::mapping {

namespace {

constexpr TimeNs kStep_ns = 10'000'000;
constexpr TimeNs kStepsMax = 64;

}  // namespace

/// See mapping.md (R44).
void bridge_gap(const WindowRate& before, const WindowRate& after, std::vector<MotionSample>& samples) {
  const TimeNs from_ns = before.time_ns, to_ns = after.from_ns;
  const TimeNs step_ns = std::max(kStep_ns, (to_ns - from_ns) / kStepsMax + 1);
  const double span_s = seconds(to_ns - from_ns), walk = InertialNoiseParams::kGapRateWalk_rad_s_sqrt_s;
  for (TimeNs at_ns = from_ns; at_ns < to_ns; at_ns += step_ns) {
    MotionSample& part = samples.emplace_back();
    part.from_ns = at_ns;
    part.time_ns = std::min(at_ns + step_ns, to_ns);
    const double gone = seconds(at_ns - from_ns + (part.time_ns - at_ns) / 2) / span_s, left = 1.0 - gone;
    part.w_WI_I_rad_s = left * before.rate_rad_s + gone * after.rate_rad_s;
    const Eigen::Array3d variance = (left * before.sigma_rad_s).array().square() +
                                    (gone * after.sigma_rad_s).array().square() + walk * walk * gone * left * span_s;
    part.rate_sigma_rad_s = variance.sqrt().min(InertialNoiseParams::kRateSigmaMax_rad_s);
    part.clipped_axes = kClipGyro;
    part.bridges_gap = true;
  }
}

}  // namespace tumble::mapping
