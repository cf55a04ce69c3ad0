// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "scenarios/summary/summary.hpp"

/// selection.hpp selects methods, metrics and simulated runs of a summary.
namespace tumble::scenarios {

/// Returns true if `name` names the method. The name "tumble" matches the method of every kind; "rate/tumble" matches
/// the method of one kind.
bool is_named(const std::string& name, Kind kind, const std::string& method);

/// Returns true if any of `names` matches the method. If `names` is empty, every method that does not need the truth
/// matches.
bool is_selected(std::span<const std::string> names, Kind kind, const MethodSummary& method);

/// Throws BadInput for a method or metric that the summary does not contain, and suggests the nearest name.
void require_held(const Summary& summary, std::span<const std::string> methods, std::span<const std::string> metrics);

/// Returns the summary with the values and failures of at most `most` simulated runs per scenario, evenly spaced in
/// seed order. Medians, intervals and counts still refer to all simulated runs.
Summary at_most_draws(const Summary& summary, std::size_t most);

}  // namespace tumble::scenarios
