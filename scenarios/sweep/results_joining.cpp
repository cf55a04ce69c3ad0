// SPDX-License-Identifier: BSD-3-Clause
#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/scoring/metric.hpp"
#include "scenarios/sweep/results_database.hpp"
#include "scenarios/text.hpp"

namespace tumble::scenarios {

namespace {

class Kept {
 public:
  const std::string& operator()(std::string_view text) {
    auto& last = last_[text.size() % last_.size()];
    if (last != nullptr && *last == text) return *last;
    auto found = texts_.find(text);
    if (found == texts_.end()) found = texts_.emplace(text).first;
    return *(last = &*found);
  }

 private:
  std::set<std::string, std::less<>> texts_;
  std::array<const std::string*, 64> last_{};
};

struct ScoreValue {
  std::int64_t outcome;
  const std::string* metric;
  double value;

  static constexpr const char *kTable = "score_values", *kPlaces = "(?, ?, ?)";
  static constexpr int kColumns = 3;
  void bind(SQLite::Statement& to, int before) const {
    to.bind(before + 1, outcome);
    to.bindNoCopy(before + 2, *metric);
    to.bind(before + 3, value);
  }
};

struct DrawValue {
  const std::string* scenario;
  std::int64_t seed;
  const std::string* metric;
  double value;
  const std::string* varied;
  double setting;

  static constexpr const char *kTable = "draw_values", *kPlaces = "(?, ?, ?, ?, ?, ?)";
  static constexpr int kColumns = 6;
  void bind(SQLite::Statement& to, int before) const {
    to.bindNoCopy(before + 1, *scenario);
    to.bind(before + 2, seed);
    to.bindNoCopy(before + 3, *metric);
    to.bind(before + 4, value);
    to.bindNoCopy(before + 5, *varied);
    to.bind(before + 6, setting);
  }
};

template <typename Row>
class RowsInto {
 public:
  explicit RowsInto(SQLite::Database& into) : one_(into, text(1)), many_(into, text(kMany)) {}

  void add(const Row& row) {
    rows_.push_back(row);
    if (rows_.size() == kMany) flush();
  }
  void flush() {
    if (rows_.size() == kMany) {
      for (std::size_t i = 0; i < kMany; ++i) rows_[i].bind(many_, static_cast<int>(i) * Row::kColumns);
      run(many_);
    } else {
      for (const Row& row : rows_) {
        row.bind(one_, 0);
        run(one_);
      }
    }
    rows_.clear();
  }

 private:
  static constexpr std::size_t kMany = 64;

  static std::string text(std::size_t rows) {
    std::string text = std::string("INSERT OR REPLACE INTO ") + Row::kTable + " VALUES " + Row::kPlaces;
    for (std::size_t i = 1; i < rows; ++i) text.append(", ").append(Row::kPlaces);
    return text;
  }
  static void run(SQLite::Statement& statement) {
    statement.exec();
    statement.reset();
  }

  std::vector<Row> rows_;
  SQLite::Statement one_, many_;
};

constexpr const char* kDraw = " WHERE scenario = ? AND seed = ? AND varied = ? AND setting = ? AND kind ";

struct ShardRow {
  std::int64_t id, seed;
  const char *scenario, *kind, *method, *status, *message, *recording_digest, *estimate_digest, *varied;
  double setting;
};

class Joining {
 public:
  Joining(SQLite::Database& into, const SQLite::Database& shard, const std::filesystem::path& path, bool mixed,
          MergeCounts& counts)
      : into_(into), shard_(shard), path_(path), mixed_(mixed), counts_(counts) {
    has_rejections_ = into.execAndGet("SELECT EXISTS (SELECT 1 FROM outcomes WHERE kind = '')").getInt() != 0;
  }

  void join_outcomes() {
    while (next(outcomes_)) {
      const ShardRow row = read(outcomes_);
      std::int64_t id = 0;
      if (take(row, id)) copy_scores(row, id);
    }
    scores_into_.flush();
  }

  void join_draws() {
    SQLite::Statement select(shard_, "SELECT scenario, seed, metric, value, varied, setting FROM draw_values");
    RowsInto<DrawValue> draws(into_);
    while (next(select)) {
      const auto whose = [&] {
        return select.getColumn(0).getString() + ", seed " + std::to_string(read_seed(select.getColumn(1).getInt64())) +
               ", " + select.getColumn(2).getString();
      };
      draws.add({&text_(select.getColumn(0).getText()), select.getColumn(1).getInt64(),
                 &text_(select.getColumn(2).getText()), stored_value(select.getColumn(3), path_, whose),
                 &text_(select.getColumn(4).getText()), select.getColumn(5).getDouble()});
    }
    draws.flush();
  }

  void join_rejections() {
    SQLite::Statement select(shard_, std::string(kColumns) + "WHERE kind = '' ORDER BY id");
    SQLite::Statement ran(into_, std::string("SELECT 1 FROM outcomes") + kDraw + "<> '' LIMIT 1");
    while (next(select)) {
      const ShardRow row = read(select);
      bind_draw(ran, row);
      const bool stands = ran.executeStep();
      ran.reset();
      const bool stored = !stands && insert(row);
      ++(stored ? counts_.added : counts_.held);
      counts_.rejected += stored;
      has_rejections_ = has_rejections_ || stored;
    }
  }

 private:
  static constexpr const char* kColumns =
      "SELECT id, seed, scenario, kind, method, status, message, recording_digest, estimate_digest, varied, setting "
      "FROM outcomes ";

  static ShardRow read(SQLite::Statement& select) {
    const auto text = [&](int column) { return select.getColumn(column).getText(); };
    return {select.getColumn(0).getInt64(),
            select.getColumn(1).getInt64(),
            text(2),
            text(3),
            text(4),
            text(5),
            text(6),
            text(7),
            text(8),
            text(9),
            select.getColumn(10).getDouble()};
  }

  static std::string words(const ShardRow& row) {
    return std::string(row.scenario) + ", seed " + std::to_string(read_seed(row.seed)) + ", " + row.kind + "/" +
           row.method;
  }

  static void bind_draw(SQLite::Statement& statement, const ShardRow& row) {
    statement.bindNoCopy(1, row.scenario);
    statement.bind(2, row.seed);
    statement.bindNoCopy(3, row.varied);
    statement.bind(4, row.setting);
  }

  bool next(SQLite::Statement& select) const {
    try {
      return select.executeStep();
    } catch (const SQLite::Exception& error) {
      throw BadInput(path_.string() + ": " + error.what());
    }
  }

  static int run(SQLite::Statement& statement) {
    const int changed = statement.exec();
    statement.reset();
    return changed;
  }

  bool insert(const ShardRow& row) {
    insert_.bindNoCopy(1, row.scenario);
    insert_.bind(2, row.seed);
    insert_.bindNoCopy(3, row.kind);
    insert_.bindNoCopy(4, row.method);
    insert_.bindNoCopy(5, row.status);
    insert_.bindNoCopy(6, row.message);
    insert_.bindNoCopy(7, row.recording_digest);
    insert_.bindNoCopy(8, row.estimate_digest);
    insert_.bindNoCopy(9, row.varied);
    insert_.bind(10, row.setting);
    return run(insert_) == 1;
  }

  bool take(const ShardRow& row, std::int64_t& id) {
    (void)stored_kind(row.kind, path_);
    const OutcomeStatus own = stored_status(row.status, path_);
    if (insert(row)) {
      ++counts_.added;
    } else if (replaces_held(row, own)) {
      insert(row);
      ++counts_.replaced;
    } else {
      ++counts_.held;
      return false;
    }
    id = into_.getLastInsertRowid();
    if (has_rejections_) {
      bind_draw(forget_, row);
      run(forget_);
    }
    return true;
  }

  bool replaces_held(const ShardRow& row, OutcomeStatus own) {
    scores_into_.flush();
    held_.bindNoCopy(1, row.scenario);
    held_.bind(2, row.seed);
    held_.bindNoCopy(3, row.kind);
    held_.bindNoCopy(4, row.method);
    held_.bindNoCopy(5, row.varied);
    held_.bind(6, row.setting);
    if (!held_.executeStep())
      throw BadInput(fmt::format("{}: a row of scenario {} is stored more than once; the database is damaged",
                                 path_.string(), row.scenario));
    const std::int64_t id = held_.getColumn(0).getInt64();
    const std::string status_text = held_.getColumn(1).getString(), recording = held_.getColumn(2).getString(),
                      estimate = held_.getColumn(3).getString();
    held_.reset();
    const OutcomeStatus known = stored_status(status_text, path_);
    if (outranks(own, known)) {
      for (SQLite::Statement* remove : {&remove_scores_, &remove_}) {
        remove->bind(1, id);
        run(*remove);
      }
      return true;
    }
    if (outranks(known, own) || mixed_ || !was_scored(known)) return false;
    if (own != known || estimate != row.estimate_digest ||
        // For methods of the kind rate, digests of recordings are not compared, because a sweep of rate methods alone
        // does not simulate lidars.
        (std::string(to_string(Kind::rate)) != row.kind && recording != row.recording_digest))
      complain(row, status_text, estimate);
    require_same_scores(row, id);
    return false;
  }

  [[noreturn]] void complain(const ShardRow& row, const std::string& known, const std::string& digest) const {
    throw BadInput(
        fmt::format("{}: {}: the result has status {} and digest '{}', but another database has status {} and digest "
                    "'{}'. Results of one build must be equal",
                    path_.string(), words(row), row.status, row.estimate_digest, known, digest));
  }

  void require_same_scores(const ShardRow& row, std::int64_t held) {
    std::map<std::string, double> known;
    held_scores_.bind(1, held);
    while (held_scores_.executeStep()) {
      const std::string metric = held_scores_.getColumn(0).getString();
      if (is_cost(metric)) continue;
      known[metric] =
          stored_value(held_scores_.getColumn(1), into_.getFilename(), [&] { return words(row) + ", " + metric; });
    }
    held_scores_.reset();
    each_score(row, [&](const char* metric, double value) {
      if (is_cost(metric)) return;
      const auto found = known.find(metric);
      if (found == known.end()) differ(row, metric, exact_text(value), "none");
      if (value != found->second && !(std::isnan(value) && std::isnan(found->second)))
        differ(row, metric, exact_text(value), exact_text(found->second));
      known.erase(found);
    });
    if (!known.empty()) differ(row, known.begin()->first, "none", exact_text(known.begin()->second));
  }

  [[noreturn]] void differ(const ShardRow& row, const std::string& metric, const std::string& here,
                           const std::string& elsewhere) const {
    throw BadInput(fmt::format("{}: {}: {} is {}, but {} in another database; results of one build must be equal",
                               path_.string(), words(row), metric, here, elsewhere));
  }

  template <typename Visit>
  void each_score(const ShardRow& row, const Visit& visit) {
    while (more_scores_ && scores_.getColumn(0).getInt64() < row.id) more_scores_ = next(scores_);
    for (; more_scores_ && scores_.getColumn(0).getInt64() == row.id; more_scores_ = next(scores_)) {
      const SQLite::Column metric = scores_.getColumn(1);
      const double value =
          stored_value(scores_.getColumn(2), path_, [&] { return words(row) + ", " + metric.getString(); });
      visit(metric.getText(), value);
    }
  }

  void copy_scores(const ShardRow& row, std::int64_t to) {
    each_score(row, [&](const char* metric, double value) { scores_into_.add({to, &text_(metric), value}); });
  }

  SQLite::Database& into_;
  const SQLite::Database& shard_;
  const std::filesystem::path& path_;
  bool mixed_;
  MergeCounts& counts_;
  bool has_rejections_ = false;
  SQLite::Statement outcomes_{shard_, std::string(kColumns) + "WHERE kind <> '' ORDER BY id"};
  SQLite::Statement scores_{shard_, "SELECT outcome, metric, value FROM score_values ORDER BY outcome, metric"};
  bool more_scores_ = next(scores_);
  SQLite::Statement insert_{
      into_,
      "INSERT INTO outcomes (scenario, seed, kind, method, status, message, recording_digest, estimate_digest, "
      "varied, setting) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?) "
      "ON CONFLICT (scenario, seed, kind, method, varied, setting) DO NOTHING"};
  SQLite::Statement held_{into_,
                          "SELECT id, status, recording_digest, estimate_digest FROM outcomes WHERE scenario = ? AND "
                          "seed = ? AND kind = ? AND method = ? AND varied = ? AND setting = ?"};
  SQLite::Statement held_scores_{into_, "SELECT metric, value FROM score_values WHERE outcome = ?"};
  // In Mode::join, the database does not delete the scores of a deleted outcome automatically.
  SQLite::Statement remove_scores_{into_, "DELETE FROM score_values WHERE outcome = ?"};
  SQLite::Statement remove_{into_, "DELETE FROM outcomes WHERE id = ?"};
  SQLite::Statement forget_{into_, std::string("DELETE FROM outcomes") + kDraw + "= ''"};
  RowsInto<ScoreValue> scores_into_{into_};
  Kept text_;
};

}  // namespace

void Results::absorb(const Results& shard, bool mixed, MergeCounts& counts) {
  impl_->guarded([&] {
    Joining joining(impl_->database, shard.impl_->database, shard.impl_->path, mixed, counts);
    joining.join_outcomes();
    joining.join_draws();
    joining.join_rejections();
  });
  for (const Certificate& certificate : shard.certificates()) store(certificate);
}

}  // namespace tumble::scenarios
