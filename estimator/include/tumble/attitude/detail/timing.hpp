// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/imu.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/time.hpp"

namespace tumble {

/// Time from `last_time_ns` to `time_ns` in `dt_s`, or the trouble that check_follows() finds; `dt_s` is then
/// untouched. Safe for any pair of stamps; gap_max_s up to 1e9.
Status elapsed(TimeNs time_ns, TimeNs last_time_ns, double gap_max_s, double& dt_s);

/// `non_finite` on NaN or infinity in the rates or forces, `out_of_range` on a component beyond 1e6 (rad/s, m/s^2):
/// no sensor says that, and the square of it may no longer be finite.
Status check(const ImuSample& sample);

}  // namespace tumble
