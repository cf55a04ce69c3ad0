// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/bench/bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "scenarios/errors.hpp"
#include "scenarios/provenance/data_digest.hpp"
#include "scenarios/scoring/metric.hpp"
#include "scenarios/statistics/statistics.hpp"

namespace tumble::scenarios {

namespace {

constexpr const char* kCost = "estimate_cpu_s";

std::string name_of(const BenchDraw& draw) {
  return draw.scenario + " " + std::to_string(draw.seed);
}

std::vector<BenchDraw> draws_of(const Suite& suite) {
  std::vector<BenchDraw> draws;
  for (const DrawClass& each : suite.classes)
    for (const auto& [scenario, seed] : each.draws) {
      draws.emplace_back();
      draws.back().scenario = scenario;
      draws.back().seed = seed;
      draws.back().group = each.name;
    }
  return draws;
}

std::optional<double> value_of(const BenchDraw& draw, const std::string& metric) {
  const auto it = draw.values.find(metric);
  if (draw.status != OutcomeStatus::ok || it == draw.values.end()) return std::nullopt;
  return it->second;
}

bool has_nothing(const BenchDraw& draw, const std::string& metric, std::span<const BenchResult> beside) {
  const auto says_so = [&](const BenchDraw* each) {
    return each != nullptr && each->status == OutcomeStatus::ok && !each->values.contains(metric);
  };
  return says_so(&draw) ||
         std::any_of(beside.begin(), beside.end(), [&](const BenchResult& other) { return says_so(other.find(draw)); });
}

}  // namespace

std::string bench_suite_name(Kind kind) {
  return std::string("bench_") + to_string(kind) + "_v1";
}

std::string bench_suite_digest(const Suite& suite) {
  std::vector<std::string> texts = {suite.name, std::to_string(suite.timeout_s)};
  for (const BenchDraw& draw : draws_of(suite)) texts.push_back(draw.group + " " + name_of(draw));
  return digest_of_texts(texts);
}

BenchResult collect_bench_result(const Results& results, const Suite& suite, const MethodInfo& method) {
  BenchResult out;
  out.suite = suite.name;
  out.suite_digest = bench_suite_digest(suite);
  out.kind = method.kind;
  out.method = method.name;
  out.version = method.version;
  out.source = method.source;
  out.build = results.note("build");
  out.draws = draws_of(suite);
  for (BenchDraw& draw : out.draws) {
    Outcome key;
    key.scenario = draw.scenario;
    key.seed = draw.seed;
    key.kind = method.kind;
    key.method = method.name;
    const std::optional<Outcome> outcome = results.find(key);
    if (!outcome)
      throw BadInput(
          fmt::format("the simulated run {} has no result of method {}; run 'tumble bench' for this method again",
                      name_of(draw), method.name));
    draw.recording = outcome->recording_digest;
    draw.status = outcome->status;
  }
  std::vector<std::string> kept = held_metrics(method.kind);
  kept.emplace_back(kCost);
  kept.insert(kept.end(), suite.shown_metrics.begin(), suite.shown_metrics.end());
  for (const ScoreRow& row : results.scores()) {
    if (row.kind != to_string(method.kind) || row.method != method.name || !std::isfinite(row.value)) continue;
    if (std::find(kept.begin(), kept.end(), row.metric) == kept.end()) continue;
    const auto is_it = [&](const BenchDraw& draw) { return draw.scenario == row.scenario && draw.seed == row.seed; };
    const auto place = std::find_if(out.draws.begin(), out.draws.end(), is_it);
    if (place != out.draws.end()) place->values[row.metric] = row.value;
  }
  return out;
}

void add_published(std::span<const BenchResult> published, Results& results) {
  results.in_one_transaction([&] {
    for (const BenchResult& result : published) {
      const std::string origin =
          fmt::format("tumble did not run this method; the scores are the published result of build {} from {}",
                      result.build, result.date);
      results.set_note(method_note(result.kind, result.method), origin);
      for (const BenchDraw& draw : result.draws) {
        Outcome outcome;
        outcome.scenario = draw.scenario;
        outcome.seed = draw.seed;
        outcome.kind = result.kind;
        outcome.method = result.method;
        outcome.status = draw.status;
        if (draw.status != OutcomeStatus::ok) outcome.message = origin;
        outcome.recording_digest = draw.recording;
        for (const auto& [metric, value] : draw.values)
          if (metric != kCost) outcome.scores.push_back({metric, value});
        results.store(outcome);
      }
    }
  });
}

void require_of_suite(const BenchResult& result, const Suite& suite) {
  const std::string digest = bench_suite_digest(suite);
  const std::string whose = full_name(result.kind, result.method);
  if (result.suite != suite.name || result.suite_digest != digest)
    throw BadInput(
        fmt::format("the result of method {} belongs to suite {} (digest {}), but this comparison needs results of "
                    "suite {} (digest {})",
                    whose, result.suite, result.suite_digest, suite.name, digest));
  const std::vector<BenchDraw> draws = draws_of(suite);
  if (result.draws.size() != draws.size())
    throw BadInput(fmt::format(
        "the result of method {} contains {} simulated runs; it must contain {}, one for each run of the bench suite",
        whose, result.draws.size(), draws.size()));
  for (const BenchDraw& draw : draws)
    if (result.find(draw) == nullptr)
      throw BadInput(fmt::format("method {} has no result of simulated run {}", whose, name_of(draw)));
}

std::string other_recording(const BenchResult& a, const BenchResult& b) {
  for (const BenchDraw& draw : a.draws) {
    const BenchDraw* other = b.find(draw);
    if (other != nullptr && !draw.recording.empty() && !other->recording.empty() && draw.recording != other->recording)
      return name_of(draw);
  }
  return "";
}

BenchCell bench_cell(const BenchResult& result, const std::string& metric, const std::string& group,
                     std::span<const BenchResult> beside) {
  BenchCell cell;
  std::vector<double> values;
  for (const BenchDraw& draw : result.draws) {
    if ((!group.empty() && draw.group != group) || has_nothing(draw, metric, beside)) continue;
    ++cell.draws;
    if (const auto value = value_of(draw, metric))
      values.push_back(*value);
    else
      ++cell.lost;
  }
  cell.median = quantile(with_failures(values, cell.lost, worst_value(metric_info(metric))), 0.5);
  return cell;
}

BenchWins bench_wins(const BenchResult& result, const BenchResult& baseline, const std::string& metric,
                     std::span<const BenchResult> beside) {
  BenchWins wins;
  const MetricInfo& info = metric_info(metric);
  for (const BenchDraw& draw : result.draws) {
    const BenchDraw* other = baseline.find(draw);
    if (other == nullptr || has_nothing(draw, metric, beside)) continue;
    ++wins.draws;
    const double worst = worst_value(info);
    if (is_better(info, value_of(draw, metric).value_or(worst), value_of(*other, metric).value_or(worst)))
      ++wins.better;
  }
  return wins;
}

}  // namespace tumble::scenarios
