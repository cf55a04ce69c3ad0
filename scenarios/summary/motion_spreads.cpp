// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/motion_spreads.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "scenarios/statistics/statistics.hpp"

namespace tumble::scenarios {

namespace {

enum class Over { draws, share_of_draws, clipped_samples };

struct Quantity {
  const char* metric;
  const char* name;
  const char* unit;
  double factor;
  const char* published;
  double low, high;  ///< in `unit`
  Over over = Over::draws;
};
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

constexpr std::array kQuantities = {
    Quantity{
        "motion_peak_rate_rad_s", "largest rate", "rad/s", 1.0,
        "up to 18.6 rad/s in the published campaign; target of the scenario 'hill': 8 to 25 rad/s, median 13 to 16",
        8.0, 25.0},
    Quantity{"motion_clipped_share", "share of the samples in motion with a clipped gyro axis", "%", 100.0, "", kNone,
             kNone},
    Quantity{"motion_several_axes_share",
             "share of the clipped samples with at least two clipped axes, per simulated run", "%", 100.0, "", kNone,
             kNone},
    Quantity{"motion_several_axes_share",
             "share of the clipped samples with at least two clipped axes, over all simulated runs", "%", 100.0,
             "target: 10 to 40", kNone, kNone, Over::clipped_samples},
    Quantity{"motion_cross_axis_share",
             "share of the clipped samples in which clipping also causes an error on an unclipped axis, over all "
             "simulated runs",
             "%", 100.0, "", kNone, kNone, Over::clipped_samples},
    Quantity{"motion_path_m", "path", "m", 1.0, "5 to 10", 5.0, 10.0},
    Quantity{"motion_peak_accel_m_s2", "largest specific force", "m/s²", 1.0,
             "up to 157.8 m/s² in the published campaign; an accelerometer with a range of 16 g saturates at 156.9",
             157.8, 157.8},
    Quantity{"motion_clips", "share of the simulated runs in which the gyro clips", "%", 100.0, "target: 90", kNone,
             kNone, Over::share_of_draws},
};

/// Computes a mean over the samples of all runs with its confidence interval. Samples within a run are correlated, so
/// each run counts as one cluster. The interval comes from the ratio estimator for cluster samples (Cochran, Sampling
/// Techniques, 1977, section 9A.2).
Interval pooled(std::span<const DrawValues* const> draws, const std::string& metric) {
  std::vector<std::pair<double, double>> weighted;  // clipped samples, fraction
  double samples = 0.0, hits = 0.0, square = 0.0;
  for (const DrawValues* draw : draws) {
    const double weight = value_of(draw->values, "motion_clipped_samples"), share = value_of(draw->values, metric);
    if (!(weight > 0.0) || !std::isfinite(share)) continue;
    weighted.emplace_back(weight, share);
    samples += weight;
    hits += weight * share;
  }
  const double mean = hits / samples, count = static_cast<double>(weighted.size());
  for (const auto& [weight, share] : weighted) square += std::pow(weight * (share - mean), 2);
  if (weighted.size() < 2) return {mean, 0.0, 1.0};
  const double half = 1.96 * std::sqrt(square * count / (count - 1.0)) / samples;
  return {mean, std::max(0.0, mean - half), std::min(1.0, mean + half)};
}

}  // namespace

std::vector<Spread> motion_spreads(std::span<const DrawValues> draws) {
  std::vector<std::string> names;  // in the order of `draws`
  std::map<std::string, std::vector<const DrawValues*>> by_scenario;
  for (const DrawValues& draw : draws) {
    std::vector<const DrawValues*>& own = by_scenario[draw.scenario];
    if (own.empty()) names.push_back(draw.scenario);
    own.push_back(&draw);
  }
  std::vector<Spread> spreads;
  for (const Quantity& quantity : kQuantities) {
    for (const std::string& name : names) {
      Spread spread;
      spread.scenario = name;
      spread.metric = quantity.metric;
      spread.quantity = quantity.name;
      spread.unit = quantity.unit;
      spread.published = quantity.published;
      spread.published_low = quantity.low;
      spread.published_high = quantity.high;
      spread.factor = quantity.factor;
      spread.of_draws = quantity.over == Over::draws;
      const std::vector<const DrawValues*>& own = by_scenario[name];
      for (const DrawValues* draw : own) {
        const double value = value_of(draw->values, quantity.metric);
        if (std::isfinite(value)) spread.values.push_back(value);
      }
      if (spread.values.empty()) continue;
      if (quantity.over == Over::clipped_samples) {
        const Interval share = pooled(own, quantity.metric);
        std::tie(spread.median, spread.quantile_05, spread.quantile_95) =
            std::tuple(share.value, share.low, share.high);
      } else if (quantity.over == Over::share_of_draws) {
        const auto count = std::count_if(spread.values.begin(), spread.values.end(), [](double v) { return v != 0.0; });
        const Interval share = share_interval(count, static_cast<std::int64_t>(spread.values.size()));
        std::tie(spread.median, spread.quantile_05, spread.quantile_95) =
            std::tuple(share.value, share.low, share.high);
      } else {
        spread.median = quantile(spread.values, 0.5);
        spread.quantile_05 = quantile(spread.values, 0.05);
        spread.quantile_95 = quantile(spread.values, 0.95);
      }
      spreads.push_back(std::move(spread));
    }
  }
  return spreads;
}

}  // namespace tumble::scenarios
