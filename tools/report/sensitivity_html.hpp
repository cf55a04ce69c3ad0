// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "scenarios/statistics/dependence.hpp"
#include "scenarios/summary/sensitivity.hpp"

namespace tumble::tools {

std::string sensitivity_html(const std::vector<scenarios::Sensitivity>& rows, const std::string& note);

std::string draws_needed_text(const std::map<std::string, std::int64_t>& draws);

/// Each class of parameter values is one step from its smallest to its largest value, at the median or fraction, with
/// its interval.
std::string dependence_svg(std::span<const scenarios::DependenceClass> classes,
                           const std::function<std::string(const scenarios::DependenceClass&)>& label_of);

}  // namespace tumble::tools
