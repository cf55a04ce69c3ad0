// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>

#include "scenarios/sweep/database_owner.hpp"
#include "scenarios/sweep/results.hpp"

namespace tumble::scenarios {

/// Joins several results databases into the database `out`. If the merge fails, `out` stays unchanged. If two rows have
/// the same scenario, seed and method, the row with the higher-ranked status is kept. Throws BadInput if two scored
/// rows differ in status, digest or a score other than the computing cost, because all results of one build must be
/// equal. If `mixed` is true, rows of different builds are joined, and if two rows of one run differ, the first row is
/// kept.
MergeCounts merge_results(const DatabaseOwner& out, std::span<const std::filesystem::path> in, bool mixed);

}  // namespace tumble::scenarios
