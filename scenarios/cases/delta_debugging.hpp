// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

/// The search finds the smallest set of items, or the smallest number, with which a simulated run still fails.
namespace tumble::scenarios {

/// A FailsWith runs a trial with only the items `kept` (ascending indices), and returns true if the trial fails; empty
/// means that the trial budget is used up.
using FailsWith = std::function<std::optional<bool>(const std::vector<std::size_t>& kept)>;

struct LeastSet {
  std::vector<std::size_t> kept;    ///< items of the smallest failing run
  std::vector<std::size_t> needed;  ///< items of `kept` without which the run does not fail
  bool complete = false;            ///< every item of `kept` is needed: the set is 1-minimal
};

/// Returns a 1-minimal failing subset of the items 0 to `count` - 1: without any single item of the subset, the run
/// does not fail. The method is delta debugging (Zeller and Hildebrandt, IEEE TSE 28:183, 2002, algorithm ddmin) with
/// tests of complements only. The run with all items must fail, and related items should be adjacent. The search needs
/// about 2 log2(count) trials if one item is needed, and at most O(count^2).
LeastSet least_failing_set(std::size_t count, const FailsWith& fails);

using FailsAt = std::function<std::optional<bool>(double value)>;

struct LeastNumber {
  double fails_at;        ///< value closest to `ideal` at which the run failed
  double holds_at;        ///< closest value to `fails_at` that did not fail; `ideal` if none was tried
  bool complete = false;  ///< `fails_at` and `holds_at` differ by at most `resolution`
};

/// Bisects between the value `failing`, at which a run fails, and the value `ideal`, at which a run is assumed to
/// succeed. Returns the failing value closest to `ideal`, within `resolution` (above 0).
LeastNumber least_failing_number(double failing, double ideal, double resolution, bool whole, const FailsAt& fails);

}  // namespace tumble::scenarios
