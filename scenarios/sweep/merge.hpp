// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>

#include "scenarios/sweep/results.hpp"

namespace tumble::scenarios {

/// Joins results databases into `out`, made or added to, in one transaction: a merge that fails leaves it as it was.
/// Of two rows of one draw and method the one that says more stays (`outranks`), whatever the order. Throws BadInput
/// when two rows that were scored differ in status or digest (a build gives one answer), when the inputs are of
/// different builds, models or scenarios, when `out` is an input, and when another process writes to it
/// (database_owner.hpp); with `mixed` rows of different builds are joined,
/// and of two that differ the first stays.
MergeCounts merge_results(const std::filesystem::path& out, std::span<const std::filesystem::path> in, bool mixed);

}  // namespace tumble::scenarios
