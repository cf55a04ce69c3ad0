// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// The methods with parameters that somebody gives, each as "rate/tumble_lag.lag_s=0.5" (the kind may be left out).
/// Throws BadInput for a text that is none, one that concerns none of the methods, an unknown parameter (the nearest
/// named), one given twice, and a value that is refused.
std::vector<Method> with_parameters(std::span<const MethodPointer> methods, std::span<const std::string> texts);

}  // namespace tumble::scenarios
