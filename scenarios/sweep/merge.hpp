// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>

#include "scenarios/sweep/database_owner.hpp"
#include "scenarios/sweep/results.hpp"

namespace tumble::scenarios {

/// Joins results databases into `out`, which may be new or existing, in one transaction. A failed merge leaves `out`
/// unchanged. Of two rows with the same scenario, seed and method, the row with the higher-ranked status is kept
/// (`outranks`).
///
/// Throws BadInput if two scored rows differ in status, digest or a score other than cost, because one build must give
/// one result. Throws BadInput if a value is not a number, or if the inputs have different builds, models or scenarios.
/// Throws BadInput if `out` is an input, or if another process writes to `out` (database_owner.hpp). If `mixed` is
/// true, rows of different builds are joined, and the first of two different rows is kept. An `out` without rows
/// receives the common keep rule of the inputs (merge_kept).
MergeCounts merge_results(const DatabaseOwner& out, std::span<const std::filesystem::path> in, bool mixed);
/// Locks the database `out`, then joins results databases into it.
MergeCounts merge_results(const std::filesystem::path& out, std::span<const std::filesystem::path> in, bool mixed);

}  // namespace tumble::scenarios
