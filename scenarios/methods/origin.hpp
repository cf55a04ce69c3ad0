// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// Whether a method does nothing about the problem, so that the others of its kind are paired with it: of rates the
/// clipped gyro as it is, of slam the chain on top of it. A kind may have none.
bool is_baseline(const MethodInfo& method);

/// Whether it was made here, by its `source`.
bool is_ours(const MethodInfo& method);

}  // namespace tumble::scenarios
