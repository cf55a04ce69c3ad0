// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/clouds/bin_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

namespace tumble::scenarios {

namespace {

constexpr std::size_t kKitti = 4;
constexpr std::array<std::size_t, 8> kOtherFloats = {3, 5, 6, 7, 8, 9, 10, 12};
constexpr std::array<std::size_t, 6> kDoubles = {3, 4, 5, 6, 7, 8};
/// The check of a .bin file reads four sections of 6000 consecutive numbers, because the points may be sorted by ring.
constexpr std::size_t kSections = 4, kInRow = 6000;
constexpr std::size_t kPerColumnMin = 25;
constexpr std::size_t kNumberBins = 16;
/// Valid coordinates [m] and intensities are 0 or have magnitudes from 1e-20 to 1e7. Values near 1e-16 are valid,
/// because a coordinate may be a range times the computed sine of 180 degrees, which is about 1e-16.
constexpr double kLargest = 1e7, kSmallest = 1e-20, kOddShareMax = 0.01;
/// A number of columns other than 4 is reported only if columns_differ() is clearly larger for this number than for 4
/// columns. In valid KITTI sweeps, columns_differ() for 3 to 12 columns exceeds the value for 4 columns by at most
/// 0.08.
constexpr double kMultipleDiffers = 1.5;
constexpr double kClearlyMore = 1.25, kClearlyMoreBy = 0.05;

struct NumberSample {
  std::vector<double> values;
  std::vector<std::size_t> index;
};

template <class Number>
NumberSample sample_of(std::span<const char> bytes) {
  const std::size_t count = bytes.size() / sizeof(Number), section = count / kSections;
  NumberSample out;
  std::size_t next = 0;
  for (std::size_t place = 0; place < kSections; ++place) {
    const std::size_t end = count <= kSections * kInRow ? count : place * section + kInRow;
    for (next = std::max(next, place * section); next < end; ++next) {
      Number value;
      std::memcpy(&value, bytes.data() + next * sizeof(value), sizeof(value));
      out.values.push_back(static_cast<double>(value));
      out.index.push_back(next);
    }
  }
  return out;
}

double odd_share(const NumberSample& sample) {
  const auto odd = [](double value) {
    return std::abs(value) > kLargest || (value != 0.0 && std::abs(value) < kSmallest);  // NaN: ray without a return
  };
  const auto count = std::count_if(sample.values.begin(), sample.values.end(), odd);
  return sample.values.empty() ? 0.0 : static_cast<double>(count) / static_cast<double>(sample.values.size());
}

std::vector<std::size_t> bins_of(const NumberSample& sample) {
  std::vector<double> sorted = sample.values;
  std::erase_if(sorted, [](double value) { return std::isnan(value); });
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> edges;
  for (std::size_t k = 1; k < kNumberBins && !sorted.empty(); ++k)
    edges.push_back(sorted[k * sorted.size() / kNumberBins]);
  std::vector<std::size_t> out;
  for (const double value : sample.values) {
    const auto edge = std::upper_bound(edges.begin(), edges.end(), value);
    out.push_back(std::isnan(value) ? kNumberBins : static_cast<std::size_t>(edge - edges.begin()));
  }
  return out;
}

using NumberHistogram = std::array<double, kNumberBins + 1>;

/// Divides the numbers of a file into columns, and compares the histogram of each column with the histogram of all
/// numbers. Returns the mean total variation distance of the histograms, minus the mean distance that random samples of
/// one distribution would have.
double columns_differ(const NumberSample& sample, const std::vector<std::size_t>& bins, std::size_t columns) {
  std::vector<NumberHistogram> counts(columns, NumberHistogram{});
  NumberHistogram all{};
  std::vector<double> sizes(columns, 0.0);
  for (std::size_t k = 0; k < bins.size(); ++k) {
    const std::size_t column = sample.index[k] % columns;
    counts[column][bins[k]] += 1.0;
    sizes[column] += 1.0;
    all[bins[k]] += 1.0;
  }
  const auto total = static_cast<double>(bins.size());
  double sum = 0.0;
  for (std::size_t column = 0; column < columns; ++column) {
    for (std::size_t bin = 0; bin < all.size(); ++bin)
      sum += 0.5 * std::abs(counts[column][bin] / sizes[column] - all[bin] / total);
  }
  const double by_chance = 0.4 * std::sqrt(static_cast<double>(kNumberBins * columns) / total);
  return std::max(sum / static_cast<double>(columns) - by_chance, 0.0);
}

struct ColumnFit {
  std::size_t columns = 0;
  double differ = 0.0;
};

template <std::size_t kCount>
ColumnFit best_of(const NumberSample& sample, std::size_t numbers_in_file,
                  const std::array<std::size_t, kCount>& candidates) {
  const std::vector<std::size_t> bins = bins_of(sample);
  ColumnFit best;
  for (const std::size_t columns : candidates) {
    if (numbers_in_file % columns != 0 || sample.values.size() < kPerColumnMin * columns) continue;
    const double differ = columns_differ(sample, bins, columns);
    if (differ > kMultipleDiffers * best.differ) best = {columns, differ};
  }
  return best;
}

std::string contradiction_of_size(std::span<const char> bytes, const ColumnFit& floats) {
  const std::string size = fmt::format(
      "the .bin file has {} bytes; its size must be a multiple of 16 (float32 x y z intensity)", bytes.size());
  if (floats.columns == 0) return fmt::format("{}; it may be truncated", size);
  return fmt::format("{}; the numbers match {} columns of float32", size, floats.columns);
}

std::string contradiction_of_numbers(std::span<const char> bytes, double odd) {
  std::string text = fmt::format(
      "{:.0f} % of the numbers, read as float32, have a magnitude above {:.0g} or below {:.0g}; at most {:.0f} % may "
      "have such a magnitude",
      100.0 * odd, kLargest, kSmallest, 100.0 * kOddShareMax);
  if (bytes.size() % sizeof(double) != 0) return text;
  const NumberSample doubles = sample_of<double>(bytes);
  const ColumnFit fit = best_of(doubles, bytes.size() / sizeof(double), kDoubles);
  if (odd_share(doubles) > kOddShareMax || fit.columns == 0) return text;
  return fmt::format("{}; the numbers match {} columns of float64", text, fit.columns);
}

}  // namespace

std::string contradiction_to_kitti(std::span<const char> bytes) {
  const NumberSample floats = sample_of<float>(bytes);
  const double odd = odd_share(floats);
  if (odd > kOddShareMax && floats.values.size() >= kPerColumnMin * kKitti) return contradiction_of_numbers(bytes, odd);
  const ColumnFit other = best_of(floats, bytes.size() / sizeof(float), kOtherFloats);
  const bool clear = other.differ > kClearlyMoreBy;
  if (bytes.size() % (kKitti * sizeof(float)) != 0) return contradiction_of_size(bytes, clear ? other : ColumnFit{});
  if (floats.values.size() < kPerColumnMin * kKitti) return "";
  const double as_kitti = columns_differ(floats, bins_of(floats), kKitti);
  if (!(other.differ > kClearlyMore * as_kitti + kClearlyMoreBy)) return "";
  return fmt::format(
      "the numbers match {} columns of float32 better than the expected 4 (x y z intensity). The distributions of the "
      "columns differ by {:.2f}, compared with {:.2f} for 4 columns (0: equal, 1: disjoint)",
      other.columns, other.differ, as_kitti);
}

}  // namespace tumble::scenarios
