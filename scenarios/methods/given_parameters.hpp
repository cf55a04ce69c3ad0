// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// A text has the form "rate/tumble_lag.lag_s=0.5"; the kind "rate/" is optional. Throws BadInput for a malformed text,
/// a text that matches no method, a repeated parameter, an invalid value, or an unknown parameter.
std::vector<Method> with_parameters(std::span<const MethodPointer> methods, std::span<const std::string> texts);

}  // namespace tumble::scenarios
