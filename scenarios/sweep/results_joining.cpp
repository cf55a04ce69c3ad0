// SPDX-License-Identifier: BSD-3-Clause
#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/scoring/metric.hpp"
#include "scenarios/sweep/results_database.hpp"
#include "scenarios/text.hpp"

namespace tumble::scenarios {

namespace {

constexpr int kSqliteFull = 13;  // as in sqlite3.h

constexpr const char* kOutcomeColumns =
    "scenario, seed, kind, method, status, message, recording_digest, estimate_digest, varied, setting";
constexpr const char* kSameDraw =
    "own.scenario = theirs.scenario AND own.seed = theirs.seed AND own.varied = theirs.varied AND "
    "own.setting = theirs.setting";
constexpr const char* kSameRun =
    "own.scenario = theirs.scenario AND own.seed = theirs.seed AND own.kind = theirs.kind AND "
    "own.method = theirs.method AND own.varied = theirs.varied AND own.setting = theirs.setting";

class Attached {
 public:
  Attached(SQLite::Database& database, const std::filesystem::path& shard) : database_(database) {
    SQLite::Statement attach(database_, "ATTACH ? AS shard");
    attach.bind(1, shard.string());
    attach.exec();
  }
  ~Attached() { database_.tryExec("DETACH shard"); }
  Attached(const Attached&) = delete;
  Attached& operator=(const Attached&) = delete;

 private:
  SQLite::Database& database_;
};

class Joining {
 public:
  Joining(SQLite::Database& database, const std::filesystem::path& shard, bool mixed, MergeCounts& counts)
      : database_(database), path_(shard), mixed_(mixed), counts_(counts) {}

  void join() {
    require_names();
    require_numbers();
    join_outcomes();
    run("INSERT OR REPLACE INTO main.draw_values SELECT scenario, seed, metric, value, varied, setting "
        "FROM shard.draw_values");
    join_rejections();
  }

 private:
  template <typename... Values>
  std::size_t run(const std::string& text, const Values&... values) {
    SQLite::Statement statement(database_, text);
    SQLite::bind(statement, values...);
    return static_cast<std::size_t>(statement.exec());
  }

  std::int64_t number(const char* query) { return database_.execAndGet(query).getInt64(); }

  void require_names() {
    SQLite::Statement names(database_, "SELECT DISTINCT kind, status FROM shard.outcomes WHERE kind <> ''");
    while (names.executeStep()) {
      (void)stored_kind(names.getColumn(0).getString(), path_);
      (void)stored_status(names.getColumn(1).getString(), path_);
    }
  }

  void require_numbers() {
    SQLite::Statement wrong(database_,
                            "SELECT o.scenario, o.seed, o.kind || '/' || o.method || ', ' || v.metric, v.value "
                            "FROM shard.score_values AS v JOIN shard.outcomes AS o ON o.id = v.outcome "
                            "WHERE typeof(v.value) IN ('text', 'blob') UNION ALL "
                            "SELECT scenario, seed, metric, value FROM shard.draw_values "
                            "WHERE typeof(value) IN ('text', 'blob') LIMIT 1");
    if (!wrong.executeStep()) return;
    (void)stored_value(wrong.getColumn(3), path_,
                       [&] { return draw_of(wrong, 0) + ", " + wrong.getColumn(2).getString(); });
  }

  void join_outcomes() {
    const std::size_t replaced = remove_outranked();
    const std::int64_t last = number("SELECT coalesce(max(id), 0) FROM main.outcomes");
    const std::size_t inserted =
        run(std::string("INSERT INTO main.outcomes (") + kOutcomeColumns + ") SELECT " + kOutcomeColumns +
            " FROM shard.outcomes WHERE kind <> '' ORDER BY id "
            "ON CONFLICT (scenario, seed, kind, method, varied, setting) DO NOTHING");
    counts_.replaced += replaced;
    counts_.added += inserted - replaced;
    run(std::string("INSERT INTO main.score_values SELECT own.id, v.metric, v.value FROM main.outcomes AS own "
                    "CROSS JOIN shard.outcomes AS theirs ON ") +
            kSameRun + " CROSS JOIN shard.score_values AS v ON v.outcome = theirs.id WHERE own.id > ?",
        last);
    run(std::string("DELETE FROM main.outcomes WHERE id IN (SELECT own.id FROM main.outcomes AS theirs "
                    "CROSS JOIN main.outcomes AS own ON ") +
            kSameDraw + " WHERE own.kind = '' AND theirs.id > ?)",
        last);
  }

  void join_rejections() {
    const std::size_t inserted =
        run(std::string("INSERT INTO main.outcomes (") + kOutcomeColumns + ") SELECT " + kOutcomeColumns +
            " FROM shard.outcomes AS theirs WHERE kind = '' AND NOT EXISTS (SELECT 1 FROM main.outcomes AS own WHERE " +
            kSameDraw +
            " AND own.kind <> '') ORDER BY id "
            "ON CONFLICT (scenario, seed, kind, method, varied, setting) DO NOTHING");
    counts_.added += inserted;
    counts_.rejected += inserted;
    counts_.held += static_cast<std::size_t>(number("SELECT count(*) FROM shard.outcomes WHERE kind = ''")) - inserted;
  }

  static std::string draw_of(SQLite::Statement& select, int column) {
    return select.getColumn(column).getString() + ", seed " +
           std::to_string(read_seed(select.getColumn(column + 1).getInt64()));
  }

  std::size_t remove_outranked() {
    SQLite::Statement pair(database_,
                           std::string("SELECT theirs.scenario, theirs.seed, theirs.kind, theirs.method, "
                                       "theirs.status, own.status, theirs.estimate_digest, own.estimate_digest, "
                                       "theirs.recording_digest, own.recording_digest, theirs.id, own.id "
                                       "FROM shard.outcomes AS theirs CROSS JOIN main.outcomes AS own ON ") +
                               kSameRun + " WHERE theirs.kind <> '' ORDER BY theirs.id");
    std::vector<std::int64_t> outranked;
    while (pair.executeStep()) {
      const auto text = [&](int column) { return pair.getColumn(column).getString(); };
      const OutcomeStatus status = stored_status(text(4), path_), known = stored_status(text(5), path_);
      const std::int64_t theirs = pair.getColumn(10).getInt64(), own = pair.getColumn(11).getInt64();
      if (outranks(status, known)) {
        outranked.push_back(own);
        continue;
      }
      ++counts_.held;
      if (outranks(known, status) || mixed_ || !was_scored(known)) continue;
      const std::string words = draw_of(pair, 0) + ", " + text(2) + "/" + text(3);
      // Digests of recordings are not compared for methods of the kind rate. If all methods of a sweep are of the kind
      // rate, the lidars are not simulated, and the digests differ.
      if (status != known || text(6) != text(7) || (text(2) != to_string(Kind::rate) && text(8) != text(9)))
        throw BadInput(fmt::format(
            "{}: {}: the result has status {} and digest '{}', but another database has status {} and digest '{}'. "
            "Results of one build must be equal",
            path_.string(), words, text(4), text(6), text(5), text(7)));
      require_same_scores(words, scores_of("shard", theirs), scores_of("main", own));
    }
    // In Mode::join, SQLite does not automatically delete the scores of a deleted outcome.
    for (const std::int64_t id : outranked) {
      run("DELETE FROM main.score_values WHERE outcome = ?", id);
      run("DELETE FROM main.outcomes WHERE id = ?", id);
    }
    return outranked.size();
  }

  using Scores = std::map<std::string, double>;

  Scores scores_of(const std::string& schema, std::int64_t outcome) {
    Scores scores;
    SQLite::Statement select(database_, "SELECT metric, value FROM " + schema + ".score_values WHERE outcome = ?");
    select.bind(1, outcome);
    while (select.executeStep()) {
      const std::string metric = select.getColumn(0).getString();
      if (!is_cost(metric)) scores[metric] = stored_value(select.getColumn(1), path_, [&] { return metric; });
    }
    return scores;
  }

  void require_same_scores(const std::string& words, const Scores& theirs, Scores known) const {
    for (const auto& [metric, value] : theirs) {
      const auto found = known.find(metric);
      if (found == known.end()) differ(words, metric, exact_text(value), "none");
      if (value != found->second && !(std::isnan(value) && std::isnan(found->second)))
        differ(words, metric, exact_text(value), exact_text(found->second));
      known.erase(found);
    }
    if (!known.empty()) differ(words, known.begin()->first, "none", exact_text(known.begin()->second));
  }

  [[noreturn]] void differ(const std::string& words, const std::string& metric, const std::string& here,
                           const std::string& elsewhere) const {
    throw BadInput(fmt::format("{}: {}: {} is {}, but {} in another database; results of one build must be equal",
                               path_.string(), words, metric, here, elsewhere));
  }

  SQLite::Database& database_;
  const std::filesystem::path& path_;
  bool mixed_;
  MergeCounts& counts_;
};

}  // namespace

void Results::absorb(const Results& shard, bool mixed, MergeCounts& counts) {
  const std::filesystem::path& path = shard.impl_->path;
  impl_->guarded([&] {
    try {
      const Attached attached(impl_->database, path);
      SQLite::Transaction transaction(impl_->database);
      Joining(impl_->database, path, mixed, counts).join();
      transaction.commit();
    } catch (const SQLite::Exception& error) {
      if (error.getErrorCode() == kSqliteFull) throw;
      throw BadInput(path.string() + ": " + error.what());
    }
  });
  for (const Certificate& certificate : shard.certificates()) store(certificate);
}

}  // namespace tumble::scenarios
