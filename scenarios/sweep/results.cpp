// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/results.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/sweep/build_id.hpp"
#include "scenarios/sweep/results_schema.hpp"

namespace tumble::scenarios {

namespace {

constexpr int kBusyTimeoutMs = 20000;
constexpr const char* kRejected = "rejected";
constexpr int kSqliteBusy = 5;  // as sqlite3.h has it
constexpr const char* kBusy = "another program is writing to it; try again when it has ended";

std::int64_t stored_seed(std::uint64_t seed) {
  return std::bit_cast<std::int64_t>(seed);
}
std::uint64_t read_seed(std::int64_t stored) {
  return std::bit_cast<std::uint64_t>(stored);
}

double read_value(const SQLite::Column& column) {
  return column.isNull() ? std::numeric_limits<double>::quiet_NaN() : column.getDouble();
}

// SQLite has no NaN: a number that is none is null
void bind_value(SQLite::Statement& statement, int index, double value) {
  if (std::isnan(value))
    statement.bind(index);
  else
    statement.bind(index, value);
}

Kind kind_named(const std::string& name, const std::filesystem::path& path) {
  for (const Kind kind : {Kind::rate, Kind::attitude, Kind::position, Kind::slam}) {
    if (name == to_string(kind)) return kind;
  }
  throw BadInput(path.string() + ": unknown kind '" + name + "'");
}

/// The condition that picks `rows`, for a table or a join with the column `varied`.
const char* picked(Rows rows) {
  switch (rows) {
    case Rows::plain:
      return "varied = ''";
    case Rows::curves:
      return "varied <> ''";
    case Rows::all:
      return "1";
  }
  return "0";
}

// what follows is a condition, and then the order
constexpr const char* kOutcomes =
    "SELECT scenario, seed, kind, method, status, message, recording_digest, estimate_digest, varied, setting "
    "FROM outcomes WHERE kind <> '' AND ";
constexpr const char* kRejections =
    "SELECT scenario, seed, message, varied, setting FROM outcomes WHERE kind = '' AND ";
constexpr const char* kInOrder = " ORDER BY varied, setting, scenario, seed, kind, method";

int open_flags(Results::Mode mode) {
  return mode == Results::Mode::read_only ? SQLite::OPEN_READONLY : SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE;
}

}  // namespace

struct Results::Impl {
  std::filesystem::path path;
  SQLite::Database database;
  bool in_transaction = false;  ///< of the caller

  /// One of its own, unless the caller has begun one.
  class Transaction {
   public:
    explicit Transaction(Impl& impl) {
      if (!impl.in_transaction) own_.emplace(impl.database, SQLite::TransactionBehavior::IMMEDIATE);
    }
    void commit() {
      if (own_) own_->commit();
    }

   private:
    std::optional<SQLite::Transaction> own_;
  };

  Impl(const std::filesystem::path& file, Mode mode)
      : path(file), database(file.string(), open_flags(mode), kBusyTimeoutMs) {
    // a rollback journal: one file, readable from a read-only folder; a store is on the disk before it returns
    if (mode == Mode::create_or_append) database.exec("PRAGMA foreign_keys = ON; PRAGMA synchronous = FULL;");
  }

  // SQLite's trouble as one line with the path
  template <typename Action>
  auto guarded(Action&& action) const {
    try {
      return action();
    } catch (const SQLite::Exception& error) {
      throw BadInput(path.string() + ": " + (error.getErrorCode() == kSqliteBusy ? kBusy : error.what()));
    }
  }

  int number(const char* pragma) { return database.execAndGet(std::string("PRAGMA ") + pragma).getInt(); }

  bool is_empty() { return database.execAndGet("SELECT count(*) FROM sqlite_master").getInt() == 0; }

  void create() {
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    // somebody else may have made it while this one waited for the lock
    if (is_empty()) {
      database.exec(kSchema);
      database.exec("PRAGMA application_id = " + std::to_string(kApplicationId));
      database.exec("PRAGMA user_version = " + std::to_string(kSchemaVersion));
      write_note("build", build_id());
    }
    transaction.commit();
  }

  void check(Mode mode) {
    if (number("application_id") != kApplicationId) throw BadInput(path.string() + ": not a results database");
    const int version = number("user_version");
    if (version != kSchemaVersion && !(mode == Mode::read_only && version == kReadableVersion)) {
      throw BadInput(path.string() + ": schema version " + std::to_string(number("user_version")) + ", must be " +
                     std::to_string(kSchemaVersion));
    }
    const std::string build = read_note("build");
    if (mode == Mode::create_or_append && build != build_id()) {
      throw BadInput(path.string() + ": written by build '" + build + "', this is '" + build_id() +
                     "'; outcomes of two builds do not mix: name another file");
    }
  }

  void write_note(const std::string& key, const std::string& text) {
    SQLite::Statement insert(database, "INSERT OR REPLACE INTO notes VALUES (?, ?)");
    insert.bind(1, key);
    insert.bind(2, text);
    insert.exec();
  }

  std::string read_note(const std::string& key) {
    SQLite::Statement select(database, "SELECT text FROM notes WHERE key = ?");
    select.bind(1, key);
    return select.executeStep() ? select.getColumn(0).getString() : std::string();
  }

  std::vector<Outcome> read_outcomes(SQLite::Statement& select) const {
    std::vector<Outcome> found;
    while (select.executeStep()) {
      Outcome row;
      row.scenario = select.getColumn(0).getString();
      row.seed = read_seed(select.getColumn(1).getInt64());
      row.kind = kind_named(select.getColumn(2).getString(), path);
      row.method = select.getColumn(3).getString();
      row.status = select.getColumn(4).getString();
      row.message = select.getColumn(5).getString();
      row.recording_digest = select.getColumn(6).getString();
      row.estimate_digest = select.getColumn(7).getString();
      row.setting = {select.getColumn(8).getString(), select.getColumn(9).getDouble()};
      found.push_back(std::move(row));
    }
    return found;
  }

  static std::vector<RejectedDraw> read_rejected(SQLite::Statement& select) {
    std::vector<RejectedDraw> found;
    while (select.executeStep()) {
      found.push_back({select.getColumn(0).getString(),
                       read_seed(select.getColumn(1).getInt64()),
                       select.getColumn(2).getString(),
                       {select.getColumn(3).getString(), select.getColumn(4).getDouble()}});
    }
    return found;
  }

  void store(const std::string& kind, const Outcome& outcome) {
    Transaction transaction(*this);
    if (!kind.empty()) {
      SQLite::Statement drawn(database,
                              "DELETE FROM outcomes WHERE scenario = ? AND seed = ? AND kind = '' AND method = '' "
                              "AND varied = ? AND setting = ?");
      drawn.bind(1, outcome.scenario);
      drawn.bind(2, stored_seed(outcome.seed));
      drawn.bind(3, outcome.setting.key);
      drawn.bind(4, outcome.setting.value);
      drawn.exec();
    }
    SQLite::Statement insert(
        database,
        "INSERT OR REPLACE INTO outcomes (scenario, seed, kind, method, status, message, "
        "recording_digest, estimate_digest, varied, setting) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    insert.bind(1, outcome.scenario);
    insert.bind(2, stored_seed(outcome.seed));
    insert.bind(3, kind);
    insert.bind(4, outcome.method);
    insert.bind(5, outcome.status);
    insert.bind(6, outcome.message);
    insert.bind(7, outcome.recording_digest);
    insert.bind(8, outcome.estimate_digest);
    insert.bind(9, outcome.setting.key);
    insert.bind(10, outcome.setting.value);
    insert.exec();
    const std::int64_t id = database.getLastInsertRowid();
    SQLite::Statement value(database, "INSERT OR REPLACE INTO score_values VALUES (?, ?, ?)");
    for (const Score& score : outcome.scores) {
      if (score.metric.empty()) continue;
      value.bind(1, id);
      value.bind(2, score.metric);
      bind_value(value, 3, score.value);
      value.exec();
      value.reset();
    }
    transaction.commit();
  }
};

Results::Results(const std::filesystem::path& path, Mode mode) {
  if (mode == Mode::read_only && !std::filesystem::exists(path)) throw BadInput(path.string() + ": no such file");
  try {
    impl_ = std::make_unique<Impl>(path, mode);
    if (mode == Mode::create_or_append && impl_->is_empty()) impl_->create();
    impl_->check(mode);
  } catch (const SQLite::Exception& error) {
    if (error.getErrorCode() == kSqliteBusy) throw BadInput(path.string() + ": " + kBusy);
    throw BadInput(path.string() + ": not a usable results database: " + error.what());
  }
}

Results::~Results() = default;
Results::Results(Results&&) noexcept = default;

void Results::store(const Outcome& outcome) {
  impl_->guarded([&] { impl_->store(to_string(outcome.kind), outcome); });
}

bool Results::store(const RejectedDraw& rejected) {
  for (const Outcome& held : outcomes_of(rejected.scenario, rejected.seed)) {
    if (held.setting == rejected.setting) return false;
  }
  Outcome outcome;
  outcome.scenario = rejected.scenario;
  outcome.seed = rejected.seed;
  outcome.status = kRejected;
  outcome.message = rejected.message;
  outcome.setting = rejected.setting;
  impl_->guarded([&] { impl_->store("", outcome); });
  return true;
}

void Results::store(const DrawValues& draw) {
  impl_->guarded([&] {
    Impl::Transaction transaction(*impl_);
    SQLite::Statement insert(impl_->database, "INSERT OR REPLACE INTO draw_values VALUES (?, ?, ?, ?, ?, ?)");
    for (const Score& score : draw.values) {
      insert.bind(1, draw.scenario);
      insert.bind(2, stored_seed(draw.seed));
      insert.bind(3, score.metric);
      bind_value(insert, 4, score.value);
      insert.bind(5, draw.setting.key);
      insert.bind(6, draw.setting.value);
      insert.exec();
      insert.reset();
    }
    transaction.commit();
  });
}

void Results::store(const Certificate& certificate) {
  impl_->guarded([&] {
    Impl::Transaction transaction(*impl_);
    SQLite::Statement remove(impl_->database, "DELETE FROM certificates WHERE build = ?");
    remove.bind(1, certificate.build);
    remove.exec();
    SQLite::Statement insert(impl_->database, "INSERT INTO certificates VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    for (std::size_t i = 0; i < certificate.entries.size(); ++i) {
      const CertificateEntry& entry = certificate.entries[i];
      insert.bind(1, certificate.build);
      insert.bind(2, static_cast<std::int64_t>(i));
      insert.bind(3, entry.row);
      insert.bind(4, entry.subject);
      insert.bind(5, entry.law);
      insert.bind(6, entry.unit);
      bind_value(insert, 7, entry.value);
      bind_value(insert, 8, entry.low);
      bind_value(insert, 9, entry.high);
      insert.bind(10, entry.note);
      insert.exec();
      insert.reset();
    }
    transaction.commit();
  });
}

void Results::set_note(const std::string& key, const std::string& text) {
  impl_->guarded([&] { impl_->write_note(key, text); });
}

std::string Results::note(const std::string& key) const {
  return impl_->guarded([&] { return impl_->read_note(key); });
}

void Results::in_one_transaction(const std::function<void()>& work) {
  impl_->guarded([&] {
    SQLite::Transaction transaction(impl_->database, SQLite::TransactionBehavior::IMMEDIATE);
    impl_->in_transaction = true;
    try {
      work();
    } catch (...) {
      impl_->in_transaction = false;
      throw;
    }
    impl_->in_transaction = false;
    transaction.commit();
  });
}

std::optional<Outcome> Results::find(const Outcome& key) const {
  for (Outcome& held : outcomes_of(key.scenario, key.seed)) {
    if (held.kind == key.kind && held.method == key.method && held.setting == key.setting) return std::move(held);
  }
  return std::nullopt;
}

bool Results::has(const std::string& scenario, std::uint64_t seed, Kind kind, const std::string& method) const {
  return impl_->guarded([&] {
    SQLite::Statement select(impl_->database,
                             "SELECT 1 FROM outcomes WHERE scenario = ? AND seed = ? AND kind = ? AND method = ? "
                             "AND varied = ''");
    select.bind(1, scenario);
    select.bind(2, stored_seed(seed));
    select.bind(3, std::string(to_string(kind)));
    select.bind(4, method);
    return select.executeStep();
  });
}

std::vector<ScoreRow> Results::scores(Rows rows) const {
  return impl_->guarded([&] {
    std::vector<ScoreRow> found;
    SQLite::Statement select(impl_->database,
                             std::string("SELECT o.scenario, o.seed, o.kind, o.method, o.status, s.metric, s.value, "
                                         "o.varied, o.setting FROM outcomes AS o LEFT JOIN score_values AS s "
                                         "ON s.outcome = o.id WHERE ") +
                                 picked(rows) +
                                 " ORDER BY o.varied, o.setting, o.scenario, o.seed, o.kind, o.method, s.metric");
    while (select.executeStep()) {
      found.push_back({select.getColumn(0).getString(),
                       read_seed(select.getColumn(1).getInt64()),
                       select.getColumn(2).getString(),
                       select.getColumn(3).getString(),
                       select.getColumn(4).getString(),
                       select.getColumn(5).isNull() ? std::string() : select.getColumn(5).getString(),
                       read_value(select.getColumn(6)),
                       {select.getColumn(7).getString(), select.getColumn(8).getDouble()}});
    }
    return found;
  });
}

std::vector<Outcome> Results::outcomes(Rows rows) const {
  return impl_->guarded([&] {
    SQLite::Statement select(impl_->database, std::string(kOutcomes) + picked(rows) + kInOrder);
    return impl_->read_outcomes(select);
  });
}

std::vector<Outcome> Results::outcomes_of(const std::string& scenario, std::uint64_t seed) const {
  return impl_->guarded([&] {
    SQLite::Statement select(impl_->database, std::string(kOutcomes) + "scenario = ? AND seed = ?" + kInOrder);
    select.bind(1, scenario);
    select.bind(2, stored_seed(seed));
    return impl_->read_outcomes(select);
  });
}

std::vector<RejectedDraw> Results::rejected(Rows rows) const {
  return impl_->guarded([&] {
    SQLite::Statement select(impl_->database, std::string(kRejections) + picked(rows) + kInOrder);
    return impl_->read_rejected(select);
  });
}

std::vector<RejectedDraw> Results::rejected_of(const std::string& scenario, std::uint64_t seed) const {
  return impl_->guarded([&] {
    SQLite::Statement select(impl_->database, std::string(kRejections) + "scenario = ? AND seed = ?" + kInOrder);
    select.bind(1, scenario);
    select.bind(2, stored_seed(seed));
    return impl_->read_rejected(select);
  });
}

std::vector<DrawValues> Results::draws(Rows rows) const {
  return impl_->guarded([&] {
    std::vector<DrawValues> draws;
    SQLite::Statement select(
        impl_->database, std::string("SELECT scenario, seed, metric, value, varied, setting FROM draw_values WHERE ") +
                             picked(rows) + " ORDER BY varied, setting, scenario, seed, metric");
    while (select.executeStep()) {
      const std::string scenario = select.getColumn(0).getString();
      const std::uint64_t seed = read_seed(select.getColumn(1).getInt64());
      const Setting setting{select.getColumn(4).getString(), select.getColumn(5).getDouble()};
      if (draws.empty() || draws.back().scenario != scenario || draws.back().seed != seed ||
          draws.back().setting != setting) {
        draws.push_back({scenario, seed, {}, setting});
      }
      draws.back().values.push_back({select.getColumn(2).getString(), read_value(select.getColumn(3))});
    }
    return draws;
  });
}

std::vector<Certificate> Results::certificates() const {
  return impl_->guarded([&] {
    std::vector<Certificate> certificates;
    SQLite::Statement select(impl_->database,
                             "SELECT build, row, subject, law, unit, value, low, high, note FROM certificates "
                             "ORDER BY build, number");
    while (select.executeStep()) {
      const std::string build = select.getColumn(0).getString();
      if (certificates.empty() || certificates.back().build != build) certificates.push_back({build, {}});
      const auto text = [&](int column) { return select.getColumn(column).getString(); };
      certificates.back().entries.push_back({text(1), text(2), text(3), text(4), read_value(select.getColumn(5)),
                                             read_value(select.getColumn(6)), read_value(select.getColumn(7)),
                                             text(8)});
    }
    return certificates;
  });
}

}  // namespace tumble::scenarios
