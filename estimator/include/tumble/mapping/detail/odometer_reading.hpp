// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble {

/// Returns `non_finite` if a number is not finite. Returns `out_of_range` if a standard deviation is not above 0, a
/// covariance is not positive definite, or a rotation matrix is not orthonormal. Returns `time_order` if a motion ends
/// before or at its start.
Status check_odometer_reading(const OdometerReading& reading);
TimeNs reading_start_ns(const OdometerReading& reading);
TimeNs reading_end_ns(const OdometerReading& reading);

}  // namespace tumble
