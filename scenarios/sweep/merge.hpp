// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace tumble::scenarios {

/// What a merge wrote: rows that were not there, rows that took the place of a worse one, and what the inputs held
/// besides, which stood already.
struct MergeCounts {
  std::size_t added = 0, replaced = 0, held = 0;
  std::size_t rejected = 0;  ///< draws, of those added
};

/// Joins results databases into `out`, made or added to, in one transaction: a merge that fails leaves it as it was.
/// Of two rows of one draw and method the one that says more stays (`outranks`), whatever the order. Throws BadInput
/// when two rows that were scored differ in status or digest (a build gives one answer), when the inputs are of
/// different builds, models or scenarios, and when `out` is an input; with `mixed` rows of different builds are joined,
/// and of two that differ the first stays.
MergeCounts merge_results(const std::filesystem::path& out, std::span<const std::filesystem::path> in, bool mixed);

}  // namespace tumble::scenarios
