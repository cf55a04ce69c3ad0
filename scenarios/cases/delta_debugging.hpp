// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace tumble::scenarios {

/// A FailsWith function simulates a run with only the removable details (items) whose indices are in `kept`, in
/// ascending order. The function returns whether the method fails, or nothing if no more runs are allowed.
using FailsWith = std::function<std::optional<bool>(const std::vector<std::size_t>& kept)>;

struct LeastSet {
  std::vector<std::size_t> kept;    ///< items of the smallest failing run
  std::vector<std::size_t> needed;  ///< items that the failure needs
  bool complete = false;            ///< no single item is removable
};

/// Returns a subset of the items 0 to `count` - 1 with which the simulated run still fails. If `complete` is true, each
/// item in `kept` is necessary: the run succeeds if any single item is removed. The method is delta debugging (Zeller
/// and Hildebrandt, IEEE TSE 28:183, 2002, algorithm ddmin). The number of trial runs is about 2 log2(count) if the
/// failure needs one item, and at most O(count^2).
LeastSet least_failing_set(std::size_t count, const FailsWith& fails);

using FailsAt = std::function<std::optional<bool>(double value)>;

struct LeastNumber {
  double fails_at;
  double holds_at;  ///< closest to `fails_at`; `ideal` if untested
  bool complete = false;
};

LeastNumber least_failing_number(double failing, double ideal, double resolution, bool whole, const FailsAt& fails);

}  // namespace tumble::scenarios
