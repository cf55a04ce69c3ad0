// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/rounded_stamps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace tumble::scenarios {

namespace {

constexpr std::int64_t kRaster_ns = 1'000'000, kLongestStep_ns = 4 * kRaster_ns;
constexpr double kLeastShare = 0.02;
constexpr std::size_t kLeast = 100;  // smallest number of stamps that is tested
constexpr double kReach_s = 0.5;
constexpr std::int64_t kStampGap_ns = kLongestStep_ns + 2 * kRaster_ns;  // longer than any regular step

class StampLine {
 public:
  explicit StampLine(std::span<const std::int64_t> piece) : piece_(piece) {
    const auto last = static_cast<double>(piece.size() - 1);
    step_ns_ = last > 0.0 ? static_cast<double>(piece.back() - piece.front()) / last : 0.0;
    sums_.resize(piece.size() + 1);
    for (std::size_t k = 0; k < piece.size(); ++k) {
      const auto i = static_cast<double>(k);
      const double v = left(k);
      const std::array<double, 4> add{i, v, i * i, i * v};
      for (std::size_t s = 0; s < add.size(); ++s) sums_[k + 1][s] = sums_[k][s] + add[s];
    }
  }

  double at_ns(std::size_t first, std::size_t end, std::size_t k) const {
    std::array<double, 4> sum{};
    for (std::size_t s = 0; s < sum.size(); ++s) sum[s] = sums_[end][s] - sums_[first][s];
    const auto n = static_cast<double>(end - first), i = static_cast<double>(k);
    const double mean = sum[0] / n, spread = sum[2] - sum[0] * mean;
    const double slope = spread > 0.0 ? (sum[3] - sum[1] * mean) / spread : 0.0;
    return sum[1] / n + slope * (i - mean) + step_ns_ * i;
  }
  double step_ns() const { return step_ns_; }

 private:
  double left(std::size_t k) const {
    return static_cast<double>(piece_[k] - piece_.front()) - step_ns_ * static_cast<double>(k);
  }

  std::span<const std::int64_t> piece_;
  double step_ns_ = 0.0;
  std::vector<std::array<double, 4>> sums_;
};

void even_out(std::span<const std::int64_t> piece, std::vector<std::int64_t>& out) {
  const StampLine line(piece);
  const auto reach = static_cast<std::size_t>(1e9 * kReach_s / std::max(line.step_ns(), 1e5));
  for (std::size_t k = 0; k < piece.size(); ++k) {
    const std::size_t first = k > reach ? k - reach : 0, end = std::min(piece.size(), k + reach + 1);
    const std::int64_t at = piece.front() + std::llround(line.at_ns(first, end, k));
    std::int64_t stamp = std::clamp(at, piece[k] - kRaster_ns, piece[k] + kRaster_ns);
    if (!out.empty()) stamp = std::max(stamp, out.back() + 1);
    out.push_back(stamp);
  }
}

}  // namespace

bool are_rounded(std::span<const std::int64_t> stamps_ns) {
  if (stamps_ns.size() < kLeast) return false;
  std::array<std::size_t, kLongestStep_ns / kRaster_ns + 2> counts{};
  std::size_t all = 0;
  for (std::size_t k = 1; k < stamps_ns.size(); ++k) {
    const std::int64_t step = stamps_ns[k] - stamps_ns[k - 1];
    if (step % kRaster_ns != 0 || step <= 0) return false;
    if (step > kLongestStep_ns + kRaster_ns) continue;
    ++counts[static_cast<std::size_t>(step / kRaster_ns)];
    ++all;
  }
  const auto least = static_cast<std::size_t>(kLeastShare * static_cast<double>(all)) + 1;
  for (std::size_t n = 1; n + 1 < counts.size(); ++n) {
    if (counts[n] < least || counts[n + 1] < least) continue;
    // If the time stamps were rounded to milliseconds, all steps are n or n + 1 ms. A clock with jitter has more than
    // two different step lengths.
    return static_cast<double>(counts[n] + counts[n + 1]) >= (1.0 - kLeastShare) * static_cast<double>(all);
  }
  return false;
}

std::vector<std::int64_t> evened(std::span<const std::int64_t> stamps_ns) {
  std::vector<std::int64_t> out;
  out.reserve(stamps_ns.size());
  for (std::size_t first = 0; first < stamps_ns.size();) {
    std::size_t end = first + 1;
    while (end < stamps_ns.size() && stamps_ns[end] - stamps_ns[end - 1] < kStampGap_ns) ++end;
    even_out(stamps_ns.subspan(first, end - first), out);
    first = end;
  }
  return out;
}

std::int64_t mean_step_ns(std::span<const std::int64_t> stamps_ns) {
  std::int64_t sum = 0, steps = 0;
  for (std::size_t k = 1; k < stamps_ns.size(); ++k) {
    const std::int64_t step = stamps_ns[k] - stamps_ns[k - 1];
    if (step < kStampGap_ns) sum += step, ++steps;
  }
  return steps > 0 ? sum / steps : 0;
}

}  // namespace tumble::scenarios
