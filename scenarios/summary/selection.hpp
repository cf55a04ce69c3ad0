// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "scenarios/summary/summary.hpp"

namespace tumble::scenarios {

/// The name "tumble" denotes the method of every kind, "rate/tumble" that of one kind.
bool is_named(const std::string& name, Kind kind, const std::string& method);

bool is_selected(std::span<const std::string> names, Kind kind, const MethodSummary& method);

void require_held(const Summary& summary, std::span<const std::string> methods, std::span<const std::string> metrics);

/// Returns a summary with at most `most` simulated runs per scenario, evenly spaced in seed order; medians, intervals
/// and counts still refer to all runs.
Summary at_most_draws(const Summary& summary, std::size_t most);

}  // namespace tumble::scenarios
