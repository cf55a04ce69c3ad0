// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

/// The functions in delta_debugging.hpp search for the smallest set of items, or the smallest number, with which a run
/// fails. The caller runs the trials of the search. If the caller returns no result, the budget is used up, and the
/// search ends with the best result so far.
namespace tumble::scenarios {

/// FailsWith returns whether a run that keeps only the items with the indices `kept` (ascending) still fails.
using FailsWith = std::function<std::optional<bool>(const std::vector<std::size_t>& kept)>;

struct LeastSet {
  std::vector<std::size_t> kept;    ///< fails
  std::vector<std::size_t> needed;  ///< items without which a run of `kept` does not fail
  bool complete = false;            ///< all of `kept` are needed: the set is 1-minimal
};

/// Returns a 1-minimal failing subset of the items 0 to `count` - 1: without any single item of this subset, the run
/// does not fail. The run with all items must fail. The method is delta debugging (Zeller and Hildebrandt, IEEE TSE
/// 28:183, 2002, algorithm ddmin), which tests complements only. The search first removes all items, then halves of the
/// remaining items, then quarters, down to single items, until no item can be removed. The caller should order the
/// items so that related items are adjacent. If adding an item can prevent the failure, a smaller failing set may
/// exist. The search needs about 2 log2(count) trials if one item is needed, and at most O(count^2). The search never
/// repeats a trial.
LeastSet least_failing_set(std::size_t count, const FailsWith& fails);

/// FailsAt returns whether a run with the number `value` still fails.
using FailsAt = std::function<std::optional<bool>(double value)>;

struct LeastNumber {
  double fails_at;        ///< closest value to `ideal` that failed
  double holds_at;        ///< closest value that did not fail; `ideal` if none was tried
  bool complete = false;  ///< `fails_at` and `holds_at` differ by at most `resolution`
};

/// Bisects between the number `failing`, at which a run fails, and the number `ideal`, at which a run is assumed to
/// succeed. Returns the failing number closest to `ideal`, within `resolution` (above 0). If `whole` is true, the
/// search tries integers only.
LeastNumber least_failing_number(double failing, double ideal, double resolution, bool whole, const FailsAt& fails);

}  // namespace tumble::scenarios
