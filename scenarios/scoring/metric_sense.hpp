// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// Whether less is better (errors), more is (overlap), or neither (coverage of an interval, which has a target; costs).
enum class Sense { less, more, neither };
Sense metric_sense(const std::string& metric);

/// Whether a metric is 0 or 1 on each draw ("map_failed"): its share says something, its median does not.
bool is_verdict(const std::string& metric);

/// The metrics that say most about a kind, best first.
std::vector<std::string> headline_metrics(Kind kind);

/// The metrics that hold a kind's reported covariance to its errors: neither less nor more is better.
std::vector<std::string> consistency_metrics(Kind kind);

}  // namespace tumble::scenarios
