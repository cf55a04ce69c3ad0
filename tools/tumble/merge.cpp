// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <tuple>

#include "scenarios/errors.hpp"
#include "scenarios/sweep/results.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

using scenarios::BadInput;
using scenarios::Results;

struct Options {
  std::filesystem::path out;
  std::vector<std::filesystem::path> in;
  bool mixed = false;
};

/// Every outcome of a database, complete with its scores.
std::vector<scenarios::Outcome> complete_outcomes(const Results& results) {
  std::map<std::tuple<std::string, std::uint64_t, std::string, std::string>, std::vector<scenarios::Score>> scores;
  for (const scenarios::ScoreRow& row : results.scores()) {
    scores[{row.scenario, row.seed, row.kind, row.method}].push_back({row.metric, row.value});
  }
  std::vector<scenarios::Outcome> outcomes = results.outcomes();
  for (scenarios::Outcome& outcome : outcomes) {
    outcome.scores = scores[{outcome.scenario, outcome.seed, to_string(outcome.kind), outcome.method}];
  }
  return outcomes;
}

int merge(const Session& session, const Options& options) {
  std::vector<Results> shards;
  for (const std::filesystem::path& path : options.in) {
    if (path == options.out) throw BadInput(path.string() + ": is both read and written");
    shards.emplace_back(path, Results::Mode::read_only);
    const std::string first = shards.front().note("build"), own = shards.back().note("build");
    if (own != first && !options.mixed) {
      throw BadInput(path.string() + ": written by build '" + own + "', the first by '" + first + "'; --mixed-builds joins them all the same");
    }
  }
  Results out(options.out, Results::Mode::create_or_append);
  std::size_t outcomes = 0, rejected = 0;
  for (const Results& shard : shards) {
    for (const scenarios::Outcome& outcome : complete_outcomes(shard)) {
      out.store(outcome);
      ++outcomes;
    }
    for (const scenarios::RejectedDraw& draw : shard.rejected()) {
      out.store(draw);
      ++rejected;
    }
  }
  for (const char* key : {"suite", "certificate"}) {
    const std::string text = shards.front().note(key);
    if (!text.empty()) out.set_note(key, text);
  }
  Table table("", {"database", "databases joined", "outcomes", "draws rejected"});
  table.align_right_from(1);
  table.add_row({options.out.string(), std::to_string(shards.size()), std::to_string(outcomes), std::to_string(rejected)});
  session.print({table}, {{"database", options.out.string()}, {"joined", shards.size()}, {"outcomes", outcomes}, {"rejected", rejected}});
  return kDone;
}

}  // namespace

Action declare_merge(CLI::App& app, const Session& session) {
  auto options = std::make_shared<Options>();
  app.add_option("OUT", options->out, "the database to make, or to add to")->required();
  app.add_option("IN", options->in, "databases to join")->required();
  app.add_flag("--mixed-builds", options->mixed, "join rows of different builds");
  return [&session, options] { return merge(session, *options); };
}

}  // namespace tumble::tools
