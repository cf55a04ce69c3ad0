// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "scenarios/summary/summary.hpp"

/// Parts of a summary: methods and metrics as people name them, some of its draws.
namespace tumble::scenarios {

/// "tumble" names the method of every kind, "rate/tumble" that of one.
bool is_named(const std::string& name, Kind kind, const std::string& method);

/// Whether any of the names is the method's; without names whether it needs no truth.
bool is_selected(std::span<const std::string> names, Kind kind, const MethodSummary& method);

/// Throws BadInput on a method or a metric that the summary does not hold, naming the nearest that it does.
void require_held(const Summary& summary, std::span<const std::string> methods, std::span<const std::string> metrics);

/// The summary's sections with at most `most` draws of each scenario, at equal steps of their seeds' order: values and
/// failures of these alone. What is said of all draws (medians, intervals, counts) stays as it was.
Summary at_most_draws(const Summary& summary, std::size_t most);

}  // namespace tumble::scenarios
