// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>

#include <bit>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <system_error>

#include "scenarios/errors.hpp"
#include "scenarios/estimates/method.hpp"
#include "scenarios/provenance/build_id.hpp"
#include "scenarios/scoring/outcome_status.hpp"
#include "scenarios/sweep/results.hpp"

namespace SQLite {
class Database;
}

namespace tumble::scenarios {

/// Application id in the SQLite file header ("TMBL"), by which this program recognises results databases.
inline constexpr int kApplicationId = 0x544d424c;
inline constexpr int kSchemaVersion = 4;
/// Older schema version that differs from the current version only in the set of allowed statuses.
inline constexpr int kReadableVersion = 3;

extern const char* const kSchema;

std::string missing_of_schema(const SQLite::Database& database);

inline constexpr int kBusyTimeoutMs = 20000;
inline constexpr int kSqliteBusy = 5;  // as in sqlite3.h
inline constexpr const char* kBusy =
    "another program is writing to this database; try again after that program has ended";

inline std::int64_t stored_seed(std::uint64_t seed) {
  return std::bit_cast<std::int64_t>(seed);
}
inline std::uint64_t read_seed(std::int64_t stored) {
  return std::bit_cast<std::uint64_t>(stored);
}

struct Results::Impl {
  std::filesystem::path path;
  SQLite::Database database;
  bool in_transaction = false;  ///< the caller has an open transaction

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

  /// A process that is killed during a transaction leaves a journal file. Only a connection with write access can roll
  /// back the transaction. rolled_back() ignores a failed rollback, because the read-only connection then reports the
  /// error.
  static const std::filesystem::path& rolled_back(const std::filesystem::path& file, Mode mode) {
    std::error_code ignored;
    if (mode != Mode::read_only || !std::filesystem::exists(file.string() + "-journal", ignored)) return file;
    try {
      SQLite::Database(file.string(), SQLite::OPEN_NOMUTEX | SQLite::OPEN_READWRITE, kBusyTimeoutMs)
          .execAndGet("SELECT count(*) FROM sqlite_master");
    } catch (const SQLite::Exception&) {
    }
    return file;
  }

  Impl(const std::filesystem::path& file, Mode mode)
      : path(file),
        database(rolled_back(file, mode).string(),
                 SQLite::OPEN_NOMUTEX |
                     (mode == Mode::read_only ? SQLite::OPEN_READONLY : SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE),
                 kBusyTimeoutMs) {
    // The results database uses a rollback journal, so the database is a single file that is readable in a read-only
    // folder.
    if (mode == Mode::read_only) return;
    database.exec(mode == Mode::join ? "PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; PRAGMA foreign_keys = OFF"
                                     : "PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON");
  }

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
    if (is_empty()) {
      database.exec(kSchema);
      database.exec("PRAGMA application_id = " + std::to_string(kApplicationId));
      database.exec("PRAGMA user_version = " + std::to_string(kSchemaVersion));
      write_note("build", build_id());
    }
    transaction.commit();
  }

  void check(Mode mode) {
    if (number("application_id") != kApplicationId)
      throw BadInput(path.string() + ": the file is not a results database of this program");
    const int version = number("user_version");
    if (version != kSchemaVersion && !(mode == Mode::read_only && version == kReadableVersion)) {
      throw BadInput(path.string() + ": schema version " + std::to_string(number("user_version")) +
                     "; this build needs version " + std::to_string(kSchemaVersion));
    }
    const std::string missing = missing_of_schema(database);
    if (!missing.empty())
      throw BadInput(path.string() + ": the file is not a usable results database, because it lacks " + missing);
    const std::string build = read_note("build");
    if (mode != Mode::read_only && build != build_id()) {
      throw BadInput(path.string() + ": written by build '" + build + "', but this is build '" + build_id() +
                     "'; one file cannot contain outcomes of two builds, so choose another file");
    }
  }

  void write_note(const std::string& key, const std::string& text) {
    SQLite::Statement insert(database, "INSERT OR REPLACE INTO notes VALUES (?, ?)");
    SQLite::bind(insert, key, text);
    insert.exec();
  }

  std::string read_note(const std::string& key) {
    SQLite::Statement select(database, "SELECT text FROM notes WHERE key = ?");
    select.bind(1, key);
    return select.executeStep() ? select.getColumn(0).getString() : std::string();
  }

  void store(const std::string& kind, const Outcome& outcome);
};

/// Reads a number from the results database. A null becomes NaN; text or a blob, which SQLite would convert to 0,
/// throws BadInput.
template <typename Row>
double stored_value(const SQLite::Column& column, const std::filesystem::path& path, const Row& row) {
  const int type = column.getType();
  if (type == SQLite::FLOAT || type == SQLite::INTEGER) return column.getDouble();
  if (type == SQLite::Null) return std::numeric_limits<double>::quiet_NaN();
  throw BadInput(path.string() + ": " + row() + ": is " + (type == SQLite::TEXT ? "text" : "a blob") +
                 "; it must be a number or null");
}

inline Kind stored_kind(const std::string& name, const std::filesystem::path& path) {
  if (const auto kind = kind_named(name)) return *kind;
  throw BadInput(path.string() + ": unknown kind '" + name + "'");
}

inline OutcomeStatus stored_status(const std::string& name, const std::filesystem::path& path) {
  if (const auto status = outcome_status_named(name)) return *status;
  throw BadInput(path.string() + ": unknown status '" + name + "'");
}

}  // namespace tumble::scenarios
