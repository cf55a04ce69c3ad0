// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tumble::baselines {

/// kForceMin_m_s2 is the smallest norm of a specific force whose direction the attitude filters use.
inline constexpr double kForceMin_m_s2 = 1e-6;

}  // namespace tumble::baselines
