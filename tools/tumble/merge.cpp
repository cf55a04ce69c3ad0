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
using scenarios::Rows;

struct Options {
  std::filesystem::path out;
  std::vector<std::filesystem::path> in;
  bool mixed = false;
};

/// Every outcome of a database, complete with its scores.
std::vector<scenarios::Outcome> complete_outcomes(const Results& results) {
  using Key = std::tuple<std::string, std::uint64_t, std::string, std::string, scenarios::Setting>;
  std::map<Key, std::vector<scenarios::Score>> scores;
  for (const scenarios::ScoreRow& row : results.scores(Rows::all)) {
    scores[{row.scenario, row.seed, row.kind, row.method, row.setting}].push_back({row.metric, row.value});
  }
  std::vector<scenarios::Outcome> outcomes = results.outcomes(Rows::all);
  for (scenarios::Outcome& outcome : outcomes) {
    outcome.scores = scores[{outcome.scenario, outcome.seed, to_string(outcome.kind), outcome.method, outcome.setting}];
  }
  return outcomes;
}

/// Outcomes of another program, or of other models and scenarios, are not comparable.
void require_same_origin(const Results& first, const Results& other, const std::filesystem::path& path) {
  const std::pair<const char*, const char*> origins[] = {{"build", "written by build"},
                                                         {"data", "made from models and scenarios"}};
  for (const auto& [key, words] : origins) {
    if (first.note(key) == other.note(key)) continue;
    throw BadInput(path.string() + ": " + words + " '" + other.note(key) + "', the first database by '" +
                   first.note(key) + "'; --mixed-builds joins them all the same");
  }
}

int merge(const Session& session, const Options& options) {
  std::vector<Results> shards;
  for (const std::filesystem::path& path : options.in) {
    if (path == options.out) throw BadInput(path.string() + ": is both read and written");
    shards.emplace_back(path, Results::Mode::read_only);
    if (!options.mixed) require_same_origin(shards.front(), shards.back(), path);
  }
  Results out(options.out, Results::Mode::create_or_append);
  std::size_t outcomes = 0, rejected = 0;
  for (const Results& shard : shards) {
    for (const scenarios::Outcome& outcome : complete_outcomes(shard)) {
      out.store(outcome);
      ++outcomes;
    }
    for (const scenarios::DrawValues& draw : shard.draws(Rows::all)) out.store(draw);
    for (const scenarios::Certificate& certificate : shard.certificates()) out.store(certificate);
    for (const scenarios::RejectedDraw& draw : shard.rejected(Rows::all)) {
      out.store(draw);
      ++rejected;
    }
  }
  // the joined database says where its rows come from, not which program has joined them
  for (const char* key : {"suite", "build", "data"}) {
    const std::string text = shards.front().note(key);
    if (!text.empty()) out.set_note(key, options.mixed && std::string_view(key) == "build" ? "mixed" : text);
  }
  Table table("", {"database", "databases joined", "outcomes", "draws rejected"});
  table.align_right_from(1);
  table.add_row(
      {options.out.string(), std::to_string(shards.size()), std::to_string(outcomes), std::to_string(rejected)});
  session.print(
      {table},
      {{"database", options.out.string()}, {"joined", shards.size()}, {"outcomes", outcomes}, {"rejected", rejected}});
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
