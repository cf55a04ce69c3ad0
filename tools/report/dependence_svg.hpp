// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>
#include <string>

#include "scenarios/statistics/dependence.hpp"

namespace tumble::tools {

/// Draws a score as a function of a scenario parameter. Each class of parameter values is one step from its smallest to
/// its largest value, at the median or fraction, with its interval. The scale is logarithmic if all centres are
/// positive and span more than a decade. Returns an SVG of about 150 by 44 pixels; empty if there are fewer than two
/// classes or no finite centre.
std::string dependence_svg(std::span<const scenarios::DependenceClass> classes,
                           const std::function<std::string(const scenarios::DependenceClass&)>& label_of);

}  // namespace tumble::tools
