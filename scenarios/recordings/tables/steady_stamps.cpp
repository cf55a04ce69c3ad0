// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/tables/steady_stamps.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/recordings/clouds/sweep_stamps.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::size_t kLineReach = 10;
constexpr double kGapSteps = 1.3;
/// Smaller differences between the line and the given time stamps are rounding errors.
constexpr std::int64_t kSame_ns = 1000;

/// Fits a line to the time stamps `first` to `last`. Returns the line's value at k minus `stamps[k]`.
double line_offset_ns(std::span<const std::int64_t> stamps, std::span<const StampBounds> bounds, std::size_t first,
                      std::size_t last, std::size_t k) {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (std::size_t i = first; i <= last; ++i) {
    const double u = static_cast<double>(i) - static_cast<double>(k);
    // Middle of the interval that contains the true time.
    const double middle = 0.5 * static_cast<double>(bounds[i].after_ns - bounds[i].before_ns);
    const double v = static_cast<double>(stamps[i] - stamps[k]) + middle;
    n += 1.0, x += u, y += v, xx += u * u, xy += u * v;
  }
  const double determinant = n * xx - x * x;
  return determinant > 0.0 ? (y * xx - x * xy) / determinant : y / n;
}

}  // namespace

std::vector<std::int64_t> steady_stamps(std::span<const std::int64_t> stamps_ns, std::span<const StampBounds> bounds) {
  std::vector<std::int64_t> steady(stamps_ns.begin(), stamps_ns.end());
  const auto median = static_cast<double>(median_step_ns(steady));
  const auto gap_before = [&](std::size_t k) {
    const auto width = static_cast<double>(bounds[k].before_ns + bounds[k].after_ns);
    return static_cast<double>(stamps_ns[k] - stamps_ns[k - 1]) > kGapSteps * median + width;
  };
  std::size_t piece = 0;  // start of the current part without gap
  for (std::size_t k = 0; k < stamps_ns.size(); ++k) {
    if (k > 0 && gap_before(k)) piece = k;
    const std::size_t first = std::max(piece, k > kLineReach ? k - kLineReach : 0);
    std::size_t last = k;
    while (last + 1 < stamps_ns.size() && last < k + kLineReach && !gap_before(last + 1)) ++last;
    const auto offset = std::llround(line_offset_ns(stamps_ns, bounds, first, last, k));
    if (std::abs(offset) > kSame_ns)
      steady[k] += std::clamp<std::int64_t>(offset, -bounds[k].before_ns, bounds[k].after_ns);
  }
  return steady;
}

}  // namespace tumble::scenarios
