// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>
#include <string>

#include "scenarios/statistics/dependence.hpp"

namespace tumble::tools {

/// The shape of a score over a number: a step for each class from its lowest to its highest number, at the height of
/// its centre within its interval, upwards what is larger; logarithmic where all centres are positive and span more
/// than a decade. An infinite end lies on the frame. Each class tells itself when pointed at, in the words of `told`.
/// An SVG of some 150 by 44 pixels in the page's colours; empty of fewer than two classes, or where no centre is
/// finite.
std::string dependence_svg(std::span<const scenarios::DependenceClass> classes,
                           const std::function<std::string(const scenarios::DependenceClass&)>& told);

}  // namespace tumble::tools
