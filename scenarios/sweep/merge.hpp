// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>

#include "scenarios/sweep/database_owner.hpp"
#include "scenarios/sweep/results.hpp"

namespace tumble::scenarios {

/// Joins results databases into `out`, made or added to, in one transaction: a merge that fails leaves it as it was.
/// Of two rows of one draw and method the one that says more stays (`outranks`), whatever the order. Throws BadInput
/// when two rows that were scored differ in status, digest or a score that is no cost (a build gives one answer), when
/// a value is no number (text, a blob), when the inputs are of different builds, models or scenarios, when `out` is an
/// input, and when another process writes to it (database_owner.hpp); with `mixed` rows of different builds are joined,
/// and of two that differ the first stays. An `out` without rows takes over the rule by which the inputs keep their
/// draws, where all have the same one (merge_kept).
MergeCounts merge_results(const DatabaseOwner& out, std::span<const std::filesystem::path> in, bool mixed);
/// The same as the owner of `out` for as long as it takes.
MergeCounts merge_results(const std::filesystem::path& out, std::span<const std::filesystem::path> in, bool mixed);

}  // namespace tumble::scenarios
