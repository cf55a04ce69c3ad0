// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tumble::baselines {

/// The attitude filters use the direction of the specific force only if its norm [m/s^2] is at least this value.
inline constexpr double kForceMin_m_s2 = 1e-6;

}  // namespace tumble::baselines
