// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

namespace tumble::scenarios {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace tumble::scenarios
