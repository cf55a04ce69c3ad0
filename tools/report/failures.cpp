// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/failures.hpp"

#include <algorithm>
#include <map>

#include "scenarios/sweep/run_again.hpp"

namespace tumble::tools {

namespace {

using scenarios::Kind;
using scenarios::Outcome;
using scenarios::Results;
using scenarios::Section;
using scenarios::Summary;

using Draw = std::pair<std::string, std::uint64_t>;

/// How many methods failed on each draw that need no truth; 0 where only others failed.
std::map<Draw, std::size_t> failures_of(const Summary& summary) {
  std::map<Draw, std::size_t> out;
  for (const Section& section : summary.sections) {
    for (const scenarios::MethodSummary& method : section.methods) {
      for (const std::uint64_t seed : method.not_ok_seeds) out[{section.scenario, seed}] += method.needs_truth ? 0 : 1;
    }
  }
  return out;
}

std::string named(Kind kind, const std::string& method) {
  return full_name(kind, method);
}

std::vector<FailedRun> failed_runs(const std::vector<Outcome>& rows, const std::map<std::string, std::string>& notes) {
  std::vector<FailedRun> runs;
  for (const Outcome& row : rows) {
    if (row.setting.is_plain() && row.status != scenarios::OutcomeStatus::ok)
      runs.push_back({named(row.kind, row.method), to_string(row.status), row.message,
                      scenarios::command_again(scenarios::key_of(row), notes)});
  }
  return runs;
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
  const auto notes = results.notes();
  FailedDraws out{ranked.size(), {}};
  for (std::size_t i = 0; i < shown; ++i) {
    FailedDraw draw{ranked[i].second->first, ranked[i].second->second, {}};
    draw.runs = failed_runs(results.outcomes_of(draw.scenario, draw.seed), notes);
    out.shown.push_back(std::move(draw));
  }
  return out;
}

}  // namespace tumble::tools
