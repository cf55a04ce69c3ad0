// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/results_database.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include <set>

namespace tumble::scenarios {

// The database stores an unsigned 64-bit seed as a signed number with the same bits. The columns `varied` and `setting`
// contain the keys and the value of a varied parameter. For unmodified scenarios and methods, the column `varied` is
// empty.
const char* const kSchema = R"sql(
CREATE TABLE notes (
  key TEXT PRIMARY KEY NOT NULL,
  text TEXT NOT NULL
) WITHOUT ROWID;

CREATE TABLE outcomes (
  id INTEGER PRIMARY KEY,
  scenario TEXT NOT NULL,
  seed INTEGER NOT NULL,
  kind TEXT NOT NULL,
  method TEXT NOT NULL,
  status TEXT NOT NULL CHECK (status IN ('ok', 'diverged', 'failed', 'crashed', 'timeout', 'killed', 'rejected')),
  message TEXT NOT NULL,
  recording_digest TEXT NOT NULL,
  estimate_digest TEXT NOT NULL,
  varied TEXT NOT NULL,
  setting REAL NOT NULL,
  UNIQUE (scenario, seed, kind, method, varied, setting)
);

CREATE TABLE score_values (
  outcome INTEGER NOT NULL REFERENCES outcomes (id) ON DELETE CASCADE,
  metric TEXT NOT NULL,
  value REAL,
  PRIMARY KEY (outcome, metric)
) WITHOUT ROWID;

CREATE VIEW scores AS
  SELECT o.scenario, o.seed, o.kind, o.method, o.status, s.metric, s.value
  FROM outcomes AS o LEFT JOIN score_values AS s ON s.outcome = o.id WHERE o.varied = '';

CREATE VIEW curves AS
  SELECT o.varied, o.setting, o.scenario, o.seed, o.kind, o.method, o.status, s.metric, s.value
  FROM outcomes AS o LEFT JOIN score_values AS s ON s.outcome = o.id WHERE o.varied <> '';

CREATE TABLE draw_values (
  scenario TEXT NOT NULL,
  seed INTEGER NOT NULL,
  metric TEXT NOT NULL,
  value REAL,
  varied TEXT NOT NULL,
  setting REAL NOT NULL,
  PRIMARY KEY (scenario, seed, varied, setting, metric)
) WITHOUT ROWID;

CREATE TABLE certificates (
  build TEXT NOT NULL,
  number INTEGER NOT NULL,
  row TEXT NOT NULL,
  subject TEXT NOT NULL,
  law TEXT NOT NULL,
  unit TEXT NOT NULL,
  value REAL,
  low REAL,
  high REAL,
  note TEXT NOT NULL,
  PRIMARY KEY (build, number)
) WITHOUT ROWID;
)sql";

namespace {

std::set<std::string> parts_of(const SQLite::Database& database) {
  std::set<std::string> parts;
  SQLite::Statement objects(database, "SELECT type || ' ' || name FROM sqlite_master WHERE type IN ('table', 'view')");
  while (objects.executeStep()) parts.insert(objects.getColumn(0).getString());
  SQLite::Statement columns(database,
                            "SELECT 'column ' || c.name || ' of table ' || m.name FROM sqlite_master AS m "
                            "JOIN pragma_table_info(m.name) AS c WHERE m.type = 'table'");
  while (columns.executeStep()) parts.insert(columns.getColumn(0).getString());
  return parts;
}

}  // namespace

std::string missing_of_schema(const SQLite::Database& database) {
  SQLite::Database model(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  model.exec(kSchema);
  const std::set<std::string> found = parts_of(database);
  std::string missing;
  for (const std::string& part : parts_of(model)) {
    if (found.contains(part)) continue;
    if (part.starts_with("table")) return part;
    if (missing.empty()) missing = part;
  }
  return missing;
}

}  // namespace tumble::scenarios
