// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Computes the time `dt_s` between two time stamps, without overflow if `gap_max_s` is at most 1e9. On error, returns
/// the status of check_stamp_order() and leaves `dt_s` unchanged.
Status elapsed_time_since_last(TimeNs time_ns, TimeNs last_time_ns, double gap_max_s, double& dt_s);

}  // namespace tumble
