// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>
#include <string>

#include "scenarios/statistics/dependence.hpp"

namespace tumble::tools {

/// Each class of parameter values is one step from its smallest to its largest value, at the median or fraction, with
/// its interval.
std::string dependence_svg(std::span<const scenarios::DependenceClass> classes,
                           const std::function<std::string(const scenarios::DependenceClass&)>& label_of);

}  // namespace tumble::tools
