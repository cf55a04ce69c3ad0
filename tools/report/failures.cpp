// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/failures.hpp"

#include <algorithm>
#include <map>

#include "scenarios/sweep/sweep_notes.hpp"

namespace tumble::tools {

namespace {

using scenarios::Kind;
using scenarios::Outcome;
using scenarios::Results;
using scenarios::Section;
using scenarios::Summary;

using Draw = std::pair<std::string, std::uint64_t>;

/// How many runs failed on each draw.
std::map<Draw, std::size_t> failures_of(const Summary& summary) {
  std::map<Draw, std::size_t> out;
  for (const Section& section : summary.sections) {
    for (const scenarios::MethodSummary& method : section.methods) {
      for (const std::uint64_t seed : method.not_ok_seeds) ++out[{section.scenario, seed}];
    }
  }
  return out;
}

std::string named(Kind kind, const std::string& method) {
  return std::string(to_string(kind)) + "/" + method;
}

std::vector<FailedRun> failed_runs(const std::vector<Outcome>& rows) {
  std::vector<FailedRun> runs;
  for (const Outcome& row : rows) {
    if (row.setting.is_plain() && row.status != scenarios::OutcomeStatus::ok)
      runs.push_back({named(row.kind, row.method), to_string(row.status), row.message});
  }
  return runs;
}

/// Of the methods of this program alone: what a file describes is not found by its name.
std::string command_for(const Results& results, const FailedDraw& draw, const std::vector<Outcome>& rows) {
  if (results.note("source") == scenarios::kRecordingsSource) return "";
  std::string methods;
  for (const Outcome& row : rows) {
    if (!row.setting.is_plain() || row.status == scenarios::OutcomeStatus::ok) continue;
    if (!results.note(scenarios::method_note(row.kind, row.method)).empty()) continue;
    methods += " --method " + scenarios::shell_word(named(row.kind, row.method));
  }
  if (methods.empty()) return "";
  const std::string seed = std::to_string(draw.seed);
  return "tumble run " + scenarios::shell_word(draw.scenario) + " --seed " + seed + methods + " -o " +
         scenarios::shell_word("failed-" + draw.scenario + "-" + seed);
}

}  // namespace

FailedDraws failed_draws(const Results& results, const Summary& summary) {
  const std::map<Draw, std::size_t> failures = failures_of(summary);
  std::vector<std::pair<std::size_t, const Draw*>> ranked;
  ranked.reserve(failures.size());
  for (const auto& [draw, count] : failures) ranked.emplace_back(count, &draw);
  std::sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : *a.second < *b.second;
  });
  const std::size_t shown = std::min(ranked.size(), kFailedDrawsShown);
  FailedDraws out{ranked.size(), {}};
  for (std::size_t i = 0; i < shown; ++i) {
    FailedDraw draw{ranked[i].second->first, ranked[i].second->second, {}, {}};
    const std::vector<Outcome> rows = results.outcomes_of(draw.scenario, draw.seed);
    draw.runs = failed_runs(rows);
    draw.command = command_for(results, draw, rows);
    out.shown.push_back(std::move(draw));
  }
  return out;
}

}  // namespace tumble::tools
