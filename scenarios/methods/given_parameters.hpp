// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// Parses parameters of methods such as "rate/tumble_lag.lag_s=0.5"; the kind "rate/" is optional.
std::vector<Method> with_parameters(std::span<const MethodPointer> methods, std::span<const std::string> texts);

}  // namespace tumble::scenarios
