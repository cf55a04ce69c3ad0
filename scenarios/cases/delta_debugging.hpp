// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

/// Searches for the least that still fails. Whoever asks runs the trials; none: there is no run left for it, and the
/// search ends with the best that it has.
namespace tumble::scenarios {

/// Whether what is kept, indices that rise, still fails.
using FailsWith = std::function<std::optional<bool>(const std::vector<std::size_t>& kept)>;

struct LeastSet {
  std::vector<std::size_t> kept;    ///< fails
  std::vector<std::size_t> needed;  ///< of these: what is kept does not fail without this one
  bool complete = false;            ///< all of `kept` are needed: the set is 1-minimal
};

/// Of the things 0 to `count` - 1, which fail together, a set that fails and no longer does when any one of it is taken
/// away: delta debugging (Zeller and Hildebrandt, IEEE Trans. Software Eng. 28:183, 2002, algorithm ddmin) by its
/// complements alone. All are taken away at once, then halves of what is left, quarters, down to single ones, these
/// again until none goes. Neighbours should belong together. What is not monotone may have smaller sets. Trials: some
/// 2 log2(count) for one needed thing, at most O(count^2); none is asked twice.
LeastSet least_failing_set(std::size_t count, const FailsWith& fails);

/// Whether the run with this number still fails.
using FailsAt = std::function<std::optional<bool>(double value)>;

struct LeastNumber {
  double fails_at;        ///< the nearest to `ideal` that was seen to fail
  double holds_at;        ///< the nearest to it that was not, `ideal` unless another was tried
  bool complete = false;  ///< the two are within `resolution`
};

/// Bisects between `failing`, which fails, and `ideal`, which is taken not to: the number nearest to `ideal` that still
/// fails, within `resolution` (above 0). `whole`: whole numbers are tried alone.
LeastNumber least_failing_number(double failing, double ideal, double resolution, bool whole, const FailsAt& fails);

}  // namespace tumble::scenarios
