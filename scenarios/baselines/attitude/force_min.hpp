// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tumble::baselines {

/// A specific force with a norm below kForceMin_m_s2 has no usable direction.
inline constexpr double kForceMin_m_s2 = 1e-6;

}  // namespace tumble::baselines
