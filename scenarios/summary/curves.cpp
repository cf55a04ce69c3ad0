// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "scenarios/scoring/binned_metric.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::size_t kDrawsPerBin = 8;
constexpr std::size_t kBinsMax = 6, kBinsMin = 3;
constexpr std::array kDrawMeasures = {"motion_clipped_share", "motion_clip_depth_max_rad_s",
                                      "motion_clip_length_max_s"};

struct Run {
  std::uint64_t seed = 0;
  bool ok = false, failed = false;
  std::vector<OutcomeView::Value> scores;

  const double* find(const std::string* metric) const {
    std::size_t place = 0;
    return find(metric, place);
  }
  const double* find(const std::string* metric, std::size_t& place) const {
    if (place < scores.size() && scores[place].metric == metric) return &scores[place].value;
    const auto found = std::find_if(scores.begin(), scores.end(), [&](const auto& s) { return s.metric == metric; });
    if (found == scores.end()) return nullptr;
    place = static_cast<std::size_t>(found - scores.begin());
    return &found->value;
  }
};

using Runs = std::map<std::string, std::vector<Run>, std::less<>>;
using RunsBySetting = std::map<std::tuple<std::string, std::string, Kind>, std::map<double, Runs>>;
using PickedRuns = std::map<std::string, std::vector<const Run*>>;

struct Use {
  bool shown, verdict;
};

class Collecting {
 public:
  void add(const OutcomeView& outcome) {
    Runs& runs = found_[{std::string(outcome.varied), std::string(outcome.scenario), outcome.kind}][outcome.setting];
    auto method = runs.find(outcome.method);
    if (method == runs.end()) method = runs.emplace(outcome.method, std::vector<Run>()).first;
    method->second.push_back(run_of(outcome));
  }

  RunsBySetting sorted() {
    const auto by_seed = [](const Run& a, const Run& b) { return a.seed < b.seed; };
    for (auto& [key, by_value] : found_) {
      for (auto& [value, runs] : by_value) {
        for (auto& [method, own] : runs) {
          if (!std::is_sorted(own.begin(), own.end(), by_seed)) std::stable_sort(own.begin(), own.end(), by_seed);
        }
      }
    }
    return std::move(found_);
  }

 private:
  Run run_of(const OutcomeView& outcome) {
    Run run{outcome.seed, outcome.status == OutcomeStatus::ok, outcome.status != OutcomeStatus::ok, {}};
    for (const OutcomeView::Value& score : outcome.scores) {
      const Use use = use_of(outcome.kind, score.metric);
      run.failed = run.failed || (use.verdict && score.value != 0.0);
      if (run.ok && use.shown && std::isfinite(score.value)) run.scores.push_back(score);
    }
    return run;
  }

  Use use_of(Kind kind, const std::string* metric) {
    const auto [place, is_new] = uses_[static_cast<std::size_t>(kind)].try_emplace(metric, Use{});
    if (is_new) {
      const std::vector<std::string> headlines = headline_metrics(kind);
      const bool headline = std::find(headlines.begin(), headlines.end(), *metric) != headlines.end();
      place->second = {headline || parse_binned(*metric), metric_info(*metric).marks_failure()};
    }
    return place->second;
  }

  RunsBySetting found_;
  std::array<std::unordered_map<const std::string*, Use>, 4> uses_;  ///< by kind
};

PickedRuns all_of(const Runs& runs) {
  PickedRuns all;
  for (const auto& [method, own] : runs) {
    for (const Run& run : own) all[method].push_back(&run);
  }
  return all;
}

bool is_scored(const PickedRuns& runs, const std::string* metric, std::uint64_t seed) {
  return std::any_of(runs.begin(), runs.end(), [&](const auto& entry) {
    const auto& own = entry.second;
    const auto found = std::lower_bound(own.begin(), own.end(), seed,
                                        [](const Run* run, std::uint64_t wanted) { return run->seed < wanted; });
    return found != own.end() && (*found)->seed == seed && (*found)->find(metric) != nullptr;
  });
}

bool point_of(const std::vector<const Run*>& own, const PickedRuns& runs, const std::string* metric,
              CurvePoint& point) {
  const MetricInfo& info = metric_info(*metric);
  std::vector<double> values;
  std::size_t without = 0, place = 0;
  for (const Run* run : own) {
    ++point.draws;
    point.failed += run->failed ? 1 : 0;
    if (const double* value = run->find(metric, place)) {
      values.push_back(*value);
    } else if (!run->ok && is_scored(runs, metric, run->seed)) {
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

void add_place(const PickedRuns& runs, const std::string* metric, const CurvePoint& place, Curve& curve) {
  for (const auto& [method, own] : runs) {
    CurvePoint point = place;
    if (!point_of(own, runs, metric, point)) continue;
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

const std::string* name_of(const std::string& metric, Names& names) {
  return &*names.insert(metric).first;
}

void add_set_curves(const Results& results, Names& names, std::vector<Curve>& all) {
  Collecting collecting;
  results.each(Rows::curves, names, [&](const OutcomeView& outcome) { collecting.add(outcome); });
  for (const auto& [key, by_value] : collecting.sorted()) {
    const auto& [varied, scenario, kind] = key;
    for (const std::string& metric : headline_metrics(kind)) {
      Curve curve{Curve::Source::set, varied, scenario, kind, metric, {}};
      for (const auto& [value, runs] : by_value) {
        CurvePoint place;
        place.x = value;
        add_place(all_of(runs), name_of(metric, names), place, curve);
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

using Bins =
    std::map<std::pair<std::string, std::string>, std::map<double, std::pair<BinnedMetric, const std::string*>>>;

Bins bins_of(const Runs& runs, Names& names) {
  std::set<const std::string*> metrics;
  for (const auto& [method, own] : runs) {
    for (const Run& run : own) {
      for (const auto& score : run.scores) metrics.insert(score.metric);
    }
  }
  Bins bins;
  const auto add = [&](const std::string* metric, bool only_known) {
    const auto bin = parse_binned(*metric);
    if (!bin || (only_known && !bins.contains({bin->axis, bin->base}))) return;
    bins[{bin->axis, bin->base}].try_emplace(bin->low, *bin, metric);
  };
  for (const std::string* metric : metrics) add(metric, false);
  for (const Metric& metric : scenarios::metrics()) add(name_of(metric.info.name, names), true);
  return bins;
}

void add_sample_curves(const RunsBySetting& plain, Names& names, std::vector<Curve>& all) {
  for (const auto& [key, by_value] : plain) {
    const auto& [varied, scenario, kind] = key;
    const Runs& runs = by_value.begin()->second;
    const PickedRuns picked = all_of(runs);
    for (const auto& [name, places] : bins_of(runs, names)) {
      Curve curve{Curve::Source::samples, name.first, scenario, kind, name.second, {}};
      double rank = 0.0;
      for (const auto& [low, bin] : places) {
        CurvePoint place;
        place.x = ++rank;
        place.label = bin_label(bin.first, metric_style(bin.first.axis).factor);
        curve.bins.push_back(place.label);
        add_place(picked, bin.second, place, curve);
      }
      keep(std::move(curve), all);
    }
  }
}

std::vector<std::pair<double, std::vector<std::uint64_t>>> bins_of_draws(std::span<const DrawValues> draws,
                                                                         const std::string& scenario,
                                                                         const std::string& measure) {
  std::vector<std::pair<double, std::uint64_t>> ranked;
  for (const DrawValues& draw : draws) {
    if (draw.scenario != scenario) continue;
    for (const Score& score : draw.values) {
      if (score.metric == measure && score.value > 0.0) ranked.emplace_back(score.value, draw.seed);
    }
  }
  std::sort(ranked.begin(), ranked.end());
  const std::size_t count = std::min(kBinsMax, ranked.size() / kDrawsPerBin);
  std::vector<std::pair<double, std::vector<std::uint64_t>>> bins;
  if (count < kBinsMin) return bins;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<double> values;
    std::vector<std::uint64_t> seeds;
    for (std::size_t k = i * ranked.size() / count; k < (i + 1) * ranked.size() / count; ++k) {
      values.push_back(ranked[k].first);
      seeds.push_back(ranked[k].second);
    }
    std::sort(seeds.begin(), seeds.end());
    bins.emplace_back(quantile(values, 0.5), std::move(seeds));
  }
  return bins;
}

PickedRuns only(const Runs& runs, const std::vector<std::uint64_t>& seeds) {
  PickedRuns kept;
  for (const auto& [method, own] : runs) {
    for (const Run& run : own) {
      if (std::binary_search(seeds.begin(), seeds.end(), run.seed)) kept[method].push_back(&run);
    }
  }
  return kept;
}

void add_draw_curves(const RunsBySetting& plain, std::span<const DrawValues> draws, Names& names,
                     std::vector<Curve>& all) {
  for (const auto& [key, by_value] : plain) {
    const auto& [varied, scenario, kind] = key;
    if (kind != Kind::rate && kind != Kind::slam) continue;
    for (const char* measure : kDrawMeasures) {
      std::vector<std::pair<double, PickedRuns>> places;
      for (const auto& [value, seeds] : bins_of_draws(draws, scenario, measure))
        places.emplace_back(value, only(by_value.begin()->second, seeds));
      if (places.empty()) continue;
      for (const std::string& metric : headline_metrics(kind)) {
        Curve curve{Curve::Source::draws, measure, scenario, kind, metric, {}};
        for (const auto& [value, runs] : places) {
          CurvePoint place;
          place.x = value;
          add_place(runs, name_of(metric, names), place, curve);
        }
        keep(std::move(curve), all);
      }
    }
  }
}

}  // namespace

std::vector<Curve> find_curves(const Results& results) {
  Summary unasked;
  return find_curves(results, results.draws(), unasked);
}

std::vector<Curve> find_curves(const Results& results, std::span<const DrawValues> draws, Summary& summary) {
  std::vector<Curve> all;
  Names names;
  add_set_curves(results, names, all);
  Collecting collecting;
  summary = summarize(results, names, [&](const OutcomeView& outcome) { collecting.add(outcome); });
  const RunsBySetting plain = collecting.sorted();
  add_sample_curves(plain, names, all);
  add_draw_curves(plain, draws, names, all);
  return all;
}

}  // namespace tumble::scenarios
