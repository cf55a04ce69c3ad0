// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>

#include "scenarios/sweep/database_owner.hpp"
#include "scenarios/sweep/results.hpp"

namespace tumble::scenarios {

/// Joins results databases into `out`; a failed merge leaves `out` unchanged. Of two rows with the same scenario, seed
/// and method, the row with the higher-ranked status is kept. Throws BadInput if two scored rows differ in status,
/// digest or a score other than cost, because one build must give one result. If `mixed` is true, rows of different
/// builds are joined; of two differing rows for the same run, the first is kept.
MergeCounts merge_results(const DatabaseOwner& out, std::span<const std::filesystem::path> in, bool mixed);

}  // namespace tumble::scenarios
