// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>
#include <string>

#include "scenarios/statistics/dependence.hpp"

namespace tumble::tools {

/// Draws a score as a function of a scenario number: one step per class, from its smallest to its largest number, at
/// its median or share, with its interval. Larger values are higher. The scale is logarithmic if all centres are
/// positive and span more than a decade. Infinite ends are drawn on the frame. Each class has a tooltip from `told`.
/// Returns an SVG of about 150 by 44 pixels in the page's colours; empty if there are fewer than two classes or no
/// finite centre.
std::string dependence_svg(std::span<const scenarios::DependenceClass> classes,
                           const std::function<std::string(const scenarios::DependenceClass&)>& told);

}  // namespace tumble::tools
