// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/timing.hpp"

namespace tumble {

Status elapsed_time_since_last(TimeNs time_ns, TimeNs last_time_ns, double gap_max_s, double& dt_s) {
  if (const Status bad = check_stamp_order(time_ns, last_time_ns, gap_max_s); !bad.ok()) return bad;
  dt_s = seconds(time_ns - last_time_ns);  // gap_max_s limits the difference, so there is no overflow
  return {};
}

}  // namespace tumble
