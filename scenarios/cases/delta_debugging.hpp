// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace tumble::scenarios {

/// A FailsWith function simulates a run with only some of its removable details; the indices of these details are in
/// `kept`, in ascending order. A FailsWith function returns whether the estimator fails on the run, or nothing if the
/// limit on the number of runs is reached.
using FailsWith = std::function<std::optional<bool>(const std::vector<std::size_t>& kept)>;

struct LeastSet {
  std::vector<std::size_t> kept;    ///< items of the smallest failing run
  std::vector<std::size_t> needed;  ///< items that the failure needs
  bool complete = false;            ///< no single item is removable
};

/// least_failing_set() finds a small set of details of a simulated run with which the estimator still fails. The
/// details have the numbers 0 to `count` - 1. If `complete` is true, the estimator succeeds if any single detail in
/// `kept` is removed. The method is delta debugging (Zeller and Hildebrandt, IEEE TSE 28:183, 2002, algorithm ddmin).
/// The number of trial runs is about 2 log2(count) if the failure needs only one detail, and at most O(count^2).
LeastSet least_failing_set(std::size_t count, const FailsWith& fails);

using FailsAt = std::function<std::optional<bool>(double value)>;

struct LeastNumber {
  double fails_at;
  double holds_at;  ///< closest to `fails_at`; `ideal` if untested
  bool complete = false;
};

LeastNumber least_failing_number(double failing, double ideal, double resolution, bool whole, const FailsAt& fails);

}  // namespace tumble::scenarios
