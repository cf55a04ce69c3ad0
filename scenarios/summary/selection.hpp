// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "scenarios/summary/summary.hpp"

namespace tumble::scenarios {

bool is_named(const std::string& name, Kind kind, const std::string& method);

bool is_selected(std::span<const std::string> names, Kind kind, const MethodSummary& method);

void require_held(const Summary& summary, std::span<const std::string> methods, std::span<const std::string> metrics);

/// Limits the number of listed runs to `most`. Medians, intervals and counts still refer to all simulated runs.
Summary at_most_draws(const Summary& summary, std::size_t most);

}  // namespace tumble::scenarios
