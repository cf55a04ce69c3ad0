// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>

#include "scenarios/sweep/database_owner.hpp"
#include "scenarios/sweep/results.hpp"

namespace tumble::scenarios {

/// Joins results databases into `out`, new or existing, in one transaction: a failed merge leaves `out` unchanged. Of
/// two rows for one draw and method, the one that `outranks` the other stays, whatever the order.
///
/// Throws BadInput if two scored rows differ in status, digest or a score other than cost (a build gives one answer);
/// if a value is not a number; if the inputs have different builds, models or scenarios; if `out` is an input; or if
/// another process writes to `out` (database_owner.hpp). With `mixed`, rows of different builds are joined, and of two
/// different rows the first stays. An `out` without rows adopts the common keep rule of the inputs (merge_kept).
MergeCounts merge_results(const DatabaseOwner& out, std::span<const std::filesystem::path> in, bool mixed);
/// The same; owns `out` while it runs.
MergeCounts merge_results(const std::filesystem::path& out, std::span<const std::filesystem::path> in, bool mixed);

}  // namespace tumble::scenarios
