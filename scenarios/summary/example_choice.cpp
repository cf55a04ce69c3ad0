// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/example_choice.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "scenarios/provenance/data_digest.hpp"

namespace tumble::scenarios {

bool typical_seed(const Summary& summary, const std::string& scenario, std::uint64_t& seed) {
  for (const Section& section : summary.sections) {
    if (section.scenario != scenario || section.kind == Kind::attitude) continue;
    const MethodSummary* base = section.find(section.baseline);
    for (const std::string& name : headline_metrics(section.kind)) {
      const MetricSummary* metric = base->find(name);
      if (metric == nullptr || metric->values.empty()) continue;
      const auto nearest = std::min_element(metric->values.begin(), metric->values.end(), [&](double a, double b) {
        return std::abs(a - metric->centre.value) < std::abs(b - metric->centre.value);
      });
      seed = metric->seeds[static_cast<std::size_t>(nearest - metric->values.begin())];
      return true;
    }
  }
  return false;
}

std::vector<ExampleDraw> choose_examples(const Summary& summary, std::span<const ExampleCandidate> candidates,
                                         std::size_t count) {
  struct Ranked {
    std::size_t round, place;
    ExampleDraw draw;
  };
  std::vector<Ranked> ranked;
  std::map<std::string, std::size_t> taken;  // number of chosen scenarios per robot
  for (const ExampleCandidate& candidate : candidates) {
    ExampleDraw draw{candidate.scenario, 0};
    if (typical_seed(summary, draw.scenario, draw.seed))
      ranked.push_back({taken[candidate.robot]++, ranked.size(), std::move(draw)});
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) { return a.round < b.round; });
  if (ranked.size() > count) ranked.resize(count);
  std::sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) { return a.place < b.place; });
  std::vector<ExampleDraw> chosen;
  for (Ranked& each : ranked) chosen.push_back(std::move(each.draw));
  return chosen;
}

std::vector<FailedOn> rank_failures(const Summary& summary) {
  std::map<ExampleDraw, std::size_t> failures;
  for (const Section& section : summary.sections) {
    for (const MethodSummary& method : section.methods) {
      for (const std::uint64_t seed : method.not_ok_seeds)
        failures[{section.scenario, seed}] += method.needs_truth ? 0 : 1;
    }
  }
  std::vector<FailedOn> ranked;
  ranked.reserve(failures.size());
  for (const auto& [draw, methods] : failures) ranked.push_back({draw, methods});
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const FailedOn& a, const FailedOn& b) { return a.methods > b.methods; });
  return ranked;
}

std::vector<ExampleDraw> choose_failures(const Summary& summary, std::span<const ExampleCandidate> candidates,
                                         std::size_t count) {
  std::vector<ExampleDraw> chosen;
  for (FailedOn& failed : rank_failures(summary)) {
    if (chosen.size() == count || failed.methods == 0) break;
    if (std::ranges::any_of(candidates, [&](const auto& each) { return each.scenario == failed.draw.scenario; }))
      chosen.push_back(std::move(failed.draw));
  }
  return chosen;
}

std::vector<Outcome> rows_to_show(const Results& results, const ExampleDraw& draw) {
  std::vector<Outcome> rows = results.outcomes_of(draw.scenario, draw.seed);
  std::erase_if(rows, [](const Outcome& row) { return !row.setting.is_plain() || !was_scored(row.status); });
  return rows;
}

std::string digest_of_rows(const Results& results, const ExampleDraw& draw) {
  std::vector<std::string> texts = {results.note("build")};
  for (const Outcome& row : rows_to_show(results, draw)) {
    for (const std::string& text : {std::string(to_string(row.kind)), row.method, std::string(to_string(row.status)),
                                    row.recording_digest, row.estimate_digest})
      texts.push_back(text);
  }
  return digest_of_texts(texts);
}

}  // namespace tumble::scenarios
