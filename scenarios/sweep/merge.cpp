// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/merge.hpp"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/sweep/results.hpp"
#include "scenarios/sweep/sweep_notes.hpp"

namespace tumble::scenarios {

namespace {

namespace fs = std::filesystem;

/// Every outcome of a database, complete with its scores.
std::vector<Outcome> complete_outcomes(const Results& results) {
  using Key = std::tuple<std::string, std::uint64_t, std::string, std::string, Setting>;
  std::map<Key, std::vector<Score>> scores;
  for (const ScoreRow& row : results.scores(Rows::all)) {
    scores[{row.scenario, row.seed, row.kind, row.method, row.setting}].push_back({row.metric, row.value});
  }
  std::vector<Outcome> outcomes = results.outcomes(Rows::all);
  for (Outcome& outcome : outcomes) {
    outcome.scores = scores[{outcome.scenario, outcome.seed, to_string(outcome.kind), outcome.method, outcome.setting}];
  }
  return outcomes;
}

/// Outcomes of another program, or of other models and scenarios, are not comparable.
void require_same_origin(const Results& first, const Results& other, const fs::path& path) {
  const std::pair<const char*, const char*> origins[] = {{"build", "written by build"},
                                                         {"data", "made from models and scenarios"}};
  for (const auto& [key, words] : origins) {
    if (first.note(key) == other.note(key)) continue;
    throw BadInput(path.string() + ": " + words + " '" + other.note(key) + "', the first database by '" +
                   first.note(key) + "'; --mixed-builds joins them all the same");
  }
}

/// The versions of methods that are not of the build are joined with their rows; two of one method are refused.
void join_method_notes(const Results& shard, const fs::path& path, bool mixed, Results& into) {
  std::set<std::string> keys;
  for (const Outcome& outcome : shard.outcomes(Rows::all)) keys.insert(method_note(outcome.kind, outcome.method));
  for (const std::string& key : keys) {
    const std::string theirs = shard.note(key), known = into.note(key);
    if (theirs.empty()) continue;
    if (!known.empty() && known != theirs && !mixed)
      throw BadInput(path.string() + ": " + key + " is '" + theirs + "', elsewhere '" + known +
                     "'; --mixed-builds joins them all the same");
    into.set_note(key, known.empty() || known == theirs ? theirs : "mixed");
  }
}

/// Two answers of one build to one question. Recordings are simulated without lidars where only rates are asked for, so
/// that their digest is no part of the answer there.
bool contradict(const Outcome& a, const Outcome& b) {
  return a.status != b.status || a.estimate_digest != b.estimate_digest ||
         (a.kind != Kind::rate && a.recording_digest != b.recording_digest);
}

[[noreturn]] void complain(const fs::path& path, const Outcome& held, const Outcome& other) {
  throw BadInput(path.string() + ": " + other.scenario + ", seed " + std::to_string(other.seed) + ", " +
                 to_string(other.kind) + "/" + other.method + ": is " + to_string(other.status) + " with digest '" +
                 other.estimate_digest + "', elsewhere " + to_string(held.status) + " with digest '" +
                 held.estimate_digest + "'; one build gives one answer");
}

class Merge {
 public:
  Merge(Results& out, bool mixed) : out_(out), mixed_(mixed) {}

  void add(const Results& shard, const fs::path& path) {
    for (const Outcome& outcome : complete_outcomes(shard)) add(outcome, path);
    for (const DrawValues& draw : shard.draws(Rows::all)) out_.store(draw);
    for (const Certificate& certificate : shard.certificates()) out_.store(certificate);
    for (const RejectedDraw& draw : shard.rejected(Rows::all)) {
      const bool stored = out_.store(draw);
      ++(stored ? counts_.added : counts_.held);
      counts_.rejected += stored;
    }
  }
  const MergeCounts& counts() const { return counts_; }

 private:
  void add(const Outcome& outcome, const fs::path& path) {
    const std::optional<Outcome> held = out_.find(outcome);
    if (held && !outranks(outcome.status, held->status)) {
      const bool equal = !outranks(held->status, outcome.status);
      if (equal && !mixed_ && was_scored(held->status) && contradict(*held, outcome)) complain(path, *held, outcome);
      ++counts_.held;
      return;
    }
    out_.store(outcome);
    ++(held ? counts_.replaced : counts_.added);
  }

  Results& out_;
  bool mixed_;
  MergeCounts counts_;
};

/// A database that was made for a merge which failed goes again.
class Made {
 public:
  explicit Made(const fs::path& path) : path_(path), is_new_(!fs::exists(path)) {}
  ~Made() {
    std::error_code ignored;
    if (is_new_ && !kept_) fs::remove(path_, ignored);
  }
  Made(const Made&) = delete;
  Made& operator=(const Made&) = delete;
  void keep() { kept_ = true; }
  bool is_new() const { return is_new_; }

 private:
  fs::path path_;
  bool is_new_, kept_ = false;
};

}  // namespace

MergeCounts merge_results(const fs::path& out, std::span<const fs::path> in, bool mixed) {
  require_not_an_input(out, in);
  std::vector<Results> shards;
  for (const fs::path& path : in) {
    shards.emplace_back(path, Results::Mode::read_only);
    if (!mixed) require_same_origin(shards.front(), shards.back(), path);
  }
  Made made(out);
  MergeCounts counts;
  {
    Results results(out, Results::Mode::create_or_append);
    results.in_one_transaction([&] {
      if (!made.is_new() && !mixed && !results.note("data").empty()) require_same_origin(shards.front(), results, out);
      Merge merge(results, mixed);
      for (std::size_t i = 0; i < shards.size(); ++i) {
        merge.add(shards[i], in[i]);
        join_method_notes(shards[i], in[i], mixed, results);
      }
      // the joined database says where its rows come from, not which program has joined them
      for (const char* key : {"suite", "build", "data", kCommandNote}) {
        std::string text;
        for (std::size_t i = 0; i < shards.size() && text.empty(); ++i) text = shards[i].note(key);
        if (!text.empty()) results.set_note(key, mixed && std::string_view(key) == "build" ? kMixedBuilds : text);
      }
      counts = merge.counts();
    });
  }
  made.keep();
  return counts;
}

}  // namespace tumble::scenarios
