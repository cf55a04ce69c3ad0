// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "scenarios/summary/summary.hpp"

/// The functions in selection.hpp select methods, metrics and simulated runs of a summary.
namespace tumble::scenarios {

/// Returns true if `name` denotes the method: "tumble" denotes the method of every kind, "rate/tumble" that of one
/// kind.
bool is_named(const std::string& name, Kind kind, const std::string& method);

/// Returns true if any of `names` denotes the method. An empty `names` denotes all methods without truth.
bool is_selected(std::span<const std::string> names, Kind kind, const MethodSummary& method);

/// Throws BadInput if the summary lacks one of these methods or metrics; the message suggests the nearest name.
void require_held(const Summary& summary, std::span<const std::string> methods, std::span<const std::string> metrics);

/// Returns a summary with the values and failures of at most `most` simulated runs per scenario, evenly spaced in seed
/// order. Medians, intervals and counts still refer to all runs.
Summary at_most_draws(const Summary& summary, std::size_t most);

}  // namespace tumble::scenarios
