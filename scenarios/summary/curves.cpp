// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "scenarios/scoring/binned_metric.hpp"
#include "scenarios/summary/summary.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::size_t kDrawsPerBin = 8;
constexpr std::size_t kBinsMax = 6, kBinsMin = 3;
/// What the simulated motion of a whole draw is sorted by (scenarios/sweep/motion_values.hpp).
constexpr std::array kDrawMeasures = {"motion_clipped_share", "motion_clip_depth_max_rad_s",
                                      "motion_clip_length_max_s"};

/// One outcome: its scores by metric, and whether it failed.
struct Run {
  std::uint64_t seed = 0;
  bool ok = false, failed = false;
  std::map<std::string, double> scores;
};

/// Runs of one kind of one scenario at one setting, by method.
using Runs = std::map<std::string, std::vector<Run>>;
using RunsBySetting = std::map<std::tuple<std::string, std::string, int>, std::map<double, Runs>>;

RunsBySetting collect(const Results& results, Rows rows) {
  std::map<std::tuple<std::string, double, std::string, std::uint64_t, std::string, std::string>, Run> runs;
  for (const ScoreRow& row : results.scores(rows)) {
    if (row.kind.empty()) continue;  // a rejected draw
    Run& run = runs[{row.setting.key, row.setting.value, row.scenario, row.seed, row.kind, row.method}];
    run.seed = row.seed;
    run.ok = row.status == OutcomeStatus::ok;
    run.failed = run.failed || !run.ok || (metric_info(row.metric).unit == Unit::verdict && row.value != 0.0);
    if (run.ok && std::isfinite(row.value)) run.scores[row.metric] = row.value;
  }
  RunsBySetting sorted;
  for (const Kind kind : {Kind::rate, Kind::attitude, Kind::position, Kind::slam}) {
    for (auto& [key, run] : runs) {
      const auto& [varied, value, scenario, seed, name, method] = key;
      if (name == to_string(kind)) sorted[{varied, scenario, static_cast<int>(kind)}][value][method].push_back(run);
    }
  }
  return sorted;
}

/// Seeds on which any method has a value of the metric: on the others a failure says nothing about it.
std::set<std::uint64_t> scored_seeds(const Runs& runs, const std::string& metric) {
  std::set<std::uint64_t> seeds;
  for (const auto& [method, own] : runs) {
    for (const Run& run : own) {
      if (run.scores.contains(metric)) seeds.insert(run.seed);
    }
  }
  return seeds;
}

/// Null when no draw has a value of the metric.
bool point_of(const std::vector<Run>& runs, const std::string& metric, const std::set<std::uint64_t>& scored,
              CurvePoint& point) {
  const MetricInfo& info = metric_info(metric);
  std::vector<double> values;
  std::size_t without = 0;
  for (const Run& run : runs) {
    ++point.draws;
    point.failed += run.failed ? 1 : 0;
    const auto found = run.scores.find(metric);
    if (found != run.scores.end()) {
      values.push_back(found->second);
    } else if (!run.ok && scored.contains(run.seed)) {
      ++without;
    }
  }
  const std::vector<double> ranked = with_failures(std::move(values), without, worst_value(info));
  point.failed_share = share_interval(point.failed, point.draws);
  point.quantile_25 = quantile(ranked, 0.25);
  point.median = quantile(ranked, 0.5);
  point.quantile_75 = quantile(ranked, 0.75);
  point.worst_5 = quantile(ranked, info.sense == Sense::higher ? 0.05 : 0.95);
  return !ranked.empty() || point.failed > 0;
}

/// Adds the runs at one place to the lines of a curve.
void add_place(const Runs& runs, const std::string& metric, const CurvePoint& place, Curve& curve) {
  const std::set<std::uint64_t> scored = scored_seeds(runs, metric);
  for (const auto& [method, own] : runs) {
    CurvePoint point = place;
    if (!point_of(own, metric, scored, point)) continue;
    auto line = std::find_if(curve.lines.begin(), curve.lines.end(),
                             [&, &name = method](const CurveLine& l) { return l.method == name; });
    if (line == curve.lines.end()) line = curve.lines.insert(line, CurveLine{method, {}});
    line->points.push_back(std::move(point));
  }
}

void keep(Curve curve, std::vector<Curve>& all) {
  const auto rank = [&](const CurveLine& line) { return method_rank(curve.kind, line.method); };
  std::stable_sort(curve.lines.begin(), curve.lines.end(),
                   [&](const CurveLine& a, const CurveLine& b) { return rank(a) < rank(b); });
  if (!curve.lines.empty()) all.push_back(std::move(curve));
}

void add_set_curves(const Results& results, std::vector<Curve>& all) {
  for (const auto& [key, by_value] : collect(results, Rows::curves)) {
    const auto& [varied, scenario, kind] = key;
    for (const std::string& metric : headline_metrics(static_cast<Kind>(kind))) {
      Curve curve{Curve::Source::set, varied, scenario, static_cast<Kind>(kind), metric, {}};
      for (const auto& [value, runs] : by_value) {
        CurvePoint place;
        place.x = value;
        add_place(runs, metric, place, curve);
      }
      keep(std::move(curve), all);
    }
  }
}

std::string bin_label(const BinnedMetric& bin, double factor) {
  if (bin.axis == "clipped_axes") return fmt::format("{:g}", bin.low);
  if (std::isinf(bin.high)) return fmt::format("over {:g}", bin.low * factor);
  return fmt::format("{:g} – {:g}", bin.low * factor, bin.high * factor);
}

void add_sample_curves(const RunsBySetting& plain, std::vector<Curve>& all) {
  for (const auto& [key, by_value] : plain) {
    const auto& [varied, scenario, kind] = key;
    const Runs& runs = by_value.begin()->second;
    // bins by axis and base, in rising order
    std::map<std::pair<std::string, std::string>, std::map<double, BinnedMetric>> bins;
    for (const auto& [method, own] : runs) {
      for (const Run& run : own) {
        for (const auto& [metric, value] : run.scores) {
          const auto bin = parse_binned(metric);
          if (bin) bins[{bin->axis, bin->base}].emplace(bin->low, *bin);
        }
      }
    }
    for (const auto& [name, places] : bins) {
      Curve curve{Curve::Source::samples, name.first, scenario, static_cast<Kind>(kind), name.second, {}};
      double rank = 0.0;
      for (const auto& [low, bin] : places) {
        CurvePoint place;
        place.x = ++rank;
        place.label = bin_label(bin, metric_style(bin.axis).factor);
        add_place(runs, bin.name(), place, curve);
      }
      keep(std::move(curve), all);
    }
  }
}

/// Draws in bins of equally many, by rising measure: (median measure, seeds).
std::vector<std::pair<double, std::set<std::uint64_t>>> bins_of_draws(std::span<const DrawValues> draws,
                                                                      const std::string& scenario,
                                                                      const std::string& measure) {
  std::vector<std::pair<double, std::uint64_t>> ranked;
  for (const DrawValues& draw : draws) {
    if (draw.scenario != scenario) continue;
    for (const Score& score : draw.values) {
      // draws that never clip have no place on an axis of clipping
      if (score.metric == measure && score.value > 0.0) ranked.emplace_back(score.value, draw.seed);
    }
  }
  std::sort(ranked.begin(), ranked.end());
  const std::size_t count = std::min(kBinsMax, ranked.size() / kDrawsPerBin);
  std::vector<std::pair<double, std::set<std::uint64_t>>> bins;
  if (count < kBinsMin) return bins;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<double> values;
    std::set<std::uint64_t> seeds;
    for (std::size_t k = i * ranked.size() / count; k < (i + 1) * ranked.size() / count; ++k) {
      values.push_back(ranked[k].first);
      seeds.insert(ranked[k].second);
    }
    bins.emplace_back(quantile(values, 0.5), std::move(seeds));
  }
  return bins;
}

Runs only(const Runs& runs, const std::set<std::uint64_t>& seeds) {
  Runs kept = runs;
  for (auto& [method, own] : kept) std::erase_if(own, [&](const Run& run) { return !seeds.contains(run.seed); });
  std::erase_if(kept, [](const auto& entry) { return entry.second.empty(); });
  return kept;
}

void add_draw_curves(const Results& results, const RunsBySetting& plain, std::vector<Curve>& all) {
  const std::vector<DrawValues> draws = results.draws();
  for (const auto& [key, by_value] : plain) {
    const auto& [varied, scenario, kind] = key;
    if (static_cast<Kind>(kind) != Kind::rate && static_cast<Kind>(kind) != Kind::slam) continue;
    for (const char* measure : kDrawMeasures) {
      const auto bins = bins_of_draws(draws, scenario, measure);
      if (bins.empty()) continue;
      for (const std::string& metric : headline_metrics(static_cast<Kind>(kind))) {
        Curve curve{Curve::Source::draws, measure, scenario, static_cast<Kind>(kind), metric, {}};
        for (const auto& [value, seeds] : bins) {
          CurvePoint place;
          place.x = value;
          add_place(only(by_value.begin()->second, seeds), metric, place, curve);
        }
        keep(std::move(curve), all);
      }
    }
  }
}

}  // namespace

std::vector<Curve> find_curves(const Results& results) {
  std::vector<Curve> all;
  add_set_curves(results, all);
  const RunsBySetting plain = collect(results, Rows::plain);
  add_sample_curves(plain, all);
  add_draw_curves(results, plain, all);
  return all;
}

}  // namespace tumble::scenarios
