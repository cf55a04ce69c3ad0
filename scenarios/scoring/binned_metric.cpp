// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/binned_metric.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <sstream>
#include <utility>

#include "scenarios/not_finite.hpp"
#include "scenarios/scoring/beside_truth.hpp"
#include "scenarios/scoring/families.hpp"
#include "scenarios/statistics/statistics.hpp"
#include "scenarios/text.hpp"

namespace tumble::scenarios {

std::string BinnedMetric::name() const {
  std::ostringstream text;
  text << base << '@' << axis << ':' << low << ':' << high;
  return text.str();
}

std::optional<BinnedMetric> parse_binned(const std::string& metric) {
  const std::size_t at = metric.find('@'), first = metric.find(':', at), second = metric.find(':', first + 1);
  if (at == std::string::npos || first == std::string::npos || second == std::string::npos) return std::nullopt;
  BinnedMetric binned{metric.substr(0, at), metric.substr(at + 1, first - at - 1), 0.0, 0.0};
  if (!read_number(metric.substr(first + 1, second - first - 1), binned.low)) return std::nullopt;
  if (!read_number(metric.substr(second + 1), binned.high)) return std::nullopt;
  return binned;
}

namespace {

enum class BinAxis { depth, length, count };

constexpr std::array kDepthEdges = {0.0, 0.5, 1.0, 2.0, 4.0, 8.0, kInfinity};  // rad/s
constexpr std::array kLengthEdges = {0.0,   0.025, 0.055,    0.105,
                                     0.205, 0.405, kInfinity};  // s, between samples at 100 Hz
constexpr std::array kCountEdges = {1.0, 2.0, 3.0, 4.0};

template <BinAxis kAxis>
constexpr const auto& edges() {
  if constexpr (kAxis == BinAxis::depth) return kDepthEdges;
  if constexpr (kAxis == BinAxis::length) return kLengthEdges;
  if constexpr (kAxis == BinAxis::count) return kCountEdges;
}

std::vector<double> segment_lengths_s(const ScoredEstimate& scored) {
  const ClippingTruth& truth = clipping_truth(scored);
  const double period_s = 1e-9 * static_cast<double>(scored.sensors().imus.front().period_ns);
  std::vector<double> lengths(truth.size(), 0.0);
  for (std::size_t begin = 0; begin < lengths.size();) {
    std::size_t end = begin;
    while (end < lengths.size() && truth.clipped_axes(end) != 0) ++end;
    const double length_s = period_s * static_cast<double>(end - begin);
    std::fill(lengths.begin() + static_cast<std::ptrdiff_t>(begin), lengths.begin() + static_cast<std::ptrdiff_t>(end),
              length_s);
    begin = std::max(end, begin + 1);
  }
  return lengths;
}

template <BinAxis kAxis>
double measure(const ScoredEstimate& scored, const PairedRate& pair) {
  if constexpr (kAxis == BinAxis::depth) return clipping_truth(scored).depth_rad_s(pair.sample);
  if constexpr (kAxis == BinAxis::length) return scored.once(segment_lengths_s)[pair.sample];
  if constexpr (kAxis == BinAxis::count) return static_cast<double>(std::popcount(pair.clipped_axes()));
}

template <BinAxis kAxis, std::size_t kBin, int kPercent>
bool error_in_bin(const ScoredEstimate& scored, double& value) {
  std::vector<double> norms;
  for (const PairedRate& pair : paired_rates(scored)) {
    if (pair.clipped_axes() == 0) continue;
    const double own = measure<kAxis>(scored, pair);
    if (own >= edges<kAxis>()[kBin] && own < edges<kAxis>()[kBin + 1]) norms.push_back(pair.error_rad_s().norm());
  }
  return quantile_of(norms, kPercent / 100.0, value);
}

template <BinAxis kAxis, std::size_t kBin>
void add_bin(const char* axis, const std::string& words, std::vector<Metric>& all) {
  const auto name = [&](const char* base) {
    return BinnedMetric{base, axis, edges<kAxis>()[kBin], edges<kAxis>()[kBin + 1]}.name();
  };
  all.push_back(
      {{name("rate_error_median_rad_s"), Unit::rad_s, words, Sense::lower}, Kind::rate, error_in_bin<kAxis, kBin, 50>});
  all.push_back({{name("rate_error_p99_rad_s"), Unit::rad_s,
                  "99th percentile of the rate error (norm) over clipped samples; the metric's name states which "
                  "clipped samples count",
                  Sense::lower},
                 Kind::rate,
                 error_in_bin<kAxis, kBin, 99>});
}

template <BinAxis kAxis, std::size_t... kBins>
void add_bins(const char* axis, const std::string& words, std::vector<Metric>& all, std::index_sequence<kBins...>) {
  (add_bin<kAxis, kBins>(axis, words, all), ...);
}

}  // namespace

std::vector<MetricInfo> binned_rate_quantities() {
  return {
      {"rate_error_median_rad_s", Unit::rad_s,
       "median rate error (norm) over the clipped samples in one bin of the plot's x axis", Sense::lower},
      {"rate_error_p99_rad_s", Unit::rad_s,
       "99th percentile of the rate error (norm) over the clipped samples in one bin of the plot's x axis",
       Sense::lower},
      {"clip_depth_rad_s", Unit::rad_s, "largest saturation deficit of a gyro axis: true rate minus clipped reading"},
      {"clip_length_s", Unit::s, "length of a segment of clipped samples"},
      {"clipped_axes", Unit::number, "number of clipped axes"},
  };
}

std::vector<Metric> binned_rate_metrics() {
  std::vector<Metric> all;
  add_bins<BinAxis::depth>("clip_depth_rad_s",
                           "median rate error (norm) over the clipped samples whose largest saturation deficit is in "
                           "the range that the metric's name states",
                           all, std::make_index_sequence<kDepthEdges.size() - 1>());
  add_bins<BinAxis::length>(
      "clip_length_s",
      "median rate error (norm) over the clipped segments whose duration is in the range that the metric's name states",
      all, std::make_index_sequence<kLengthEdges.size() - 1>());
  add_bins<BinAxis::count>(
      "clipped_axes",
      "median rate error (norm) over clipped samples; the metric's name states the number of clipped gyro axes", all,
      std::make_index_sequence<kCountEdges.size() - 1>());
  return all;
}

}  // namespace tumble::scenarios
