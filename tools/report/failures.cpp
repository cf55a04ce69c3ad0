// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/failures.hpp"

#include <algorithm>
#include <map>
#include <system_error>

#include "scenarios/summary/example_choice.hpp"
#include "scenarios/sweep/keep.hpp"
#include "scenarios/sweep/run_again.hpp"

namespace tumble::tools {

namespace {

using scenarios::Kind;
using scenarios::Outcome;
using scenarios::Results;
using scenarios::Summary;

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

std::string replay_of_kept(const std::filesystem::path& folder, const scenarios::ExampleDraw& draw) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(folder / "recording.h5", error)) return "";
  return "tumble replay " + scenarios::shell_word((folder / "recording.h5").string()) + " " +
         scenarios::shell_word((folder / "estimates").string()) + "/* -o " +
         scenarios::shell_word(draw.scenario + "-" + std::to_string(draw.seed) + ".html");
}

}  // namespace

FailedDraws failed_draws(const Results& results, const Summary& summary, const std::filesystem::path& database) {
  const scenarios::KeptDraws kept(database);
  std::vector<scenarios::FailedOn> ranked = scenarios::rank_failures(summary);
  FailedDraws out{ranked.size(), {}};
  ranked.resize(std::min(ranked.size(), kFailedDrawsShown));
  const auto notes = results.notes();
  for (const auto& [at, methods] : ranked) {
    FailedDraw draw{at.scenario, at.seed, {}, replay_of_kept(kept.folder_of({at.scenario, at.seed}), at)};
    draw.runs = failed_runs(results.outcomes_of(draw.scenario, draw.seed), notes);
    out.shown.push_back(std::move(draw));
  }
  return out;
}

}  // namespace tumble::tools
