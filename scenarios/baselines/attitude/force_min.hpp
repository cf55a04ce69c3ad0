// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tumble::baselines {

inline constexpr double kForceMin_m_s2 = 1e-6;

}  // namespace tumble::baselines
