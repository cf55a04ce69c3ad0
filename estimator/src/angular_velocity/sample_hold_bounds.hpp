// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace tumble {

/// If a sensor repeats a reading for more than kSlowest samples, the cause is rest, saturation or a frozen axis.
namespace sample_hold {
inline constexpr double kMoving_rad_s = 0.3, kRepeatsMin = 0.05, kSlowest = 10.0, kAgreementMin = 0.9;
inline constexpr std::size_t kMovingMin = 30, kMovingMax = 1000;
}  // namespace sample_hold

}  // namespace tumble
