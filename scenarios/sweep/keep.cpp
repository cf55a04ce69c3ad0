// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/keep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>

#include "scenarios/errors.hpp"
#include "scenarios/scoring/metric.hpp"
#include "scenarios/text.hpp"

namespace tumble::scenarios {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kCountMax = 1000;
constexpr std::string_view kWorst = "worst:";

std::string ranking_metric(Kind kind) {
  for (const std::string& name : headline_metrics(kind)) {
    const MetricInfo& info = metric_info(name);
    if (info.sense != Sense::none && info.unit != Unit::verdict) return name;
  }
  return {};
}

bool needs_truth(Kind kind, std::string_view method) {
  const auto all = methods();
  return std::any_of(all.begin(), all.end(), [&](const Method& m) {
    return m.info.kind == kind && m.info.name == method && m.info.needs_truth;
  });
}

std::optional<double> badness(const OutcomeView& row, const std::string& metric) {
  if (row.status != OutcomeStatus::ok) return std::numeric_limits<double>::infinity();
  for (const OutcomeView::Value& score : row.scores) {
    if (*score.metric != metric) continue;
    const double bad = how_bad(metric_info(metric), score.value);
    return std::isnan(bad) ? std::nullopt : std::optional(bad);
  }
  return std::nullopt;
}

class Worst {
 public:
  void add(double badness, std::uint64_t seed, std::size_t count) {
    draws_.insert({-badness, seed});
    if (draws_.size() > count) draws_.erase(std::prev(draws_.end()));
  }
  const std::set<std::pair<double, std::uint64_t>>& draws() const { return draws_; }

 private:
  std::set<std::pair<double, std::uint64_t>> draws_;  // worst first, then by seed
};

std::set<DrawName> worst_draws(const Results& results, std::size_t count) {
  std::map<Kind, std::string> metric_of;
  for (const Kind kind : kKinds) metric_of[kind] = ranking_metric(kind);
  std::map<std::tuple<std::string, Kind, std::string>, Worst> worst;
  Names names;
  results.each(Rows::plain, names, [&](const OutcomeView& row) {
    if (const auto bad = badness(row, metric_of[row.kind]))
      worst[{std::string(row.scenario), row.kind, std::string(row.method)}].add(*bad, row.seed, count);
  });
  std::set<DrawName> out;
  for (const auto& [key, own] : worst) {
    if (needs_truth(std::get<1>(key), std::get<2>(key))) continue;
    for (const auto& [bad, seed] : own.draws()) out.insert({std::get<0>(key), seed});
  }
  return out;
}

}  // namespace

Keep parse_keep(const std::string& text) {
  if (text == "none") return {};
  if (text == "failed") return {Keep::Which::failed, 0};
  if (text == "all") return {Keep::Which::all, 0};
  if (text.starts_with(kWorst)) {
    std::size_t count = 0;
    if (read_number(std::string_view(text).substr(kWorst.size()), count) && count >= 1 && count <= kCountMax)
      return {Keep::Which::worst, count};
  }
  throw BadInput(fmt::format(
      "the rule for kept simulated runs is '{}'; it must be none, failed, all, or worst:N with N from 1 to {}", text,
      kCountMax));
}

std::string to_string(const Keep& keep) {
  switch (keep.which) {
    case Keep::Which::failed:
      return "failed";
    case Keep::Which::worst:
      return std::string(kWorst) + std::to_string(keep.count);
    case Keep::Which::all:
      return "all";
    case Keep::Which::none:
      break;
  }
  return "none";
}

std::set<DrawName> draws_to_keep(const Results& results, const Keep& keep) {
  if (keep.which == Keep::Which::worst) return worst_draws(results, keep.count);
  std::set<DrawName> out;
  if (keep.which == Keep::Which::none) return out;
  Names names;
  results.each(Rows::plain, names, [&](const OutcomeView& row) {
    if (keep.which == Keep::Which::all || row.status != OutcomeStatus::ok)
      out.insert({std::string(row.scenario), row.seed});
  });
  return out;
}

}  // namespace tumble::scenarios
