// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tumble::scenarios {

inline constexpr double kStandardGravity_m_s2 = 9.80665;

}  // namespace tumble::scenarios
