// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/imu.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/time.hpp"

namespace tumble {

/// Time from `last_time_ns` to `time_ns` in `dt_s`, or the trouble that check_follows() finds; `dt_s` is then
/// untouched. Safe for any pair of stamps; gap_max_s up to 1e9.
Status elapsed(TimeNs time_ns, TimeNs last_time_ns, double gap_max_s, double& dt_s);

}  // namespace tumble
