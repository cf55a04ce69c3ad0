// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/rolling/detail/rolling_params.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

void require_valid(const RollingParams& p) {
  require_valid_fields(p);
  require_in_interval("lever_arm_m", p.lever_arm_m.norm(), 0.0, 10.0);
  if (p.q_WI_start) require_in_interval("q_WI_start", p.q_WI_start->norm(), 1.0 - 1e-6, 1.0 + 1e-6);
}

}  // namespace tumble
