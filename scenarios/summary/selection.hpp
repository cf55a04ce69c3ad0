// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "scenarios/summary/summary.hpp"

/// Selects methods, metrics and draws of a summary.
namespace tumble::scenarios {

/// "tumble" names the method of every kind, "rate/tumble" that of one.
bool is_named(const std::string& name, Kind kind, const std::string& method);

/// Returns true if any name matches the method; without names, if it needs no truth.
bool is_selected(std::span<const std::string> names, Kind kind, const MethodSummary& method);

/// Throws BadInput for a method or metric that the summary lacks; suggests the nearest name.
void require_held(const Summary& summary, std::span<const std::string> methods, std::span<const std::string> metrics);

/// Returns the summary with the values and failures of at most `most` draws per scenario, evenly spaced in seed order.
/// Medians, intervals and counts still refer to all draws.
Summary at_most_draws(const Summary& summary, std::size_t most);

}  // namespace tumble::scenarios
