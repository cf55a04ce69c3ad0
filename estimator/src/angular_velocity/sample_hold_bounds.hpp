// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace tumble {

/// Who holds readings, in a recording (find_held) and live (HoldWatch): samples in motion are looked at, so many at
/// least and at most, of which this share repeats; what repeats for more steps of the log stands still, is blind or
/// frozen.
namespace sample_hold {
inline constexpr double kMoving_rad_s = 0.3, kRepeatsMin = 0.05, kSlowest = 10.0, kAgreementMin = 0.9;
inline constexpr std::size_t kMovingMin = 30, kMovingMax = 1000;
}  // namespace sample_hold

}  // namespace tumble
