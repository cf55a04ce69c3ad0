// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// Returns the methods with the parameter values in `texts`. A text has the form "rate/tumble_lag.lag_s=0.5"; the kind
/// "rate/" is optional. Throws BadInput for a malformed text, a text that matches no method, a repeated parameter, an
/// invalid value, or an unknown parameter (the message suggests the nearest name).
std::vector<Method> with_parameters(std::span<const MethodPointer> methods, std::span<const std::string> texts);

}  // namespace tumble::scenarios
