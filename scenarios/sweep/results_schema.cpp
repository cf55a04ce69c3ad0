// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/results_schema.hpp"

namespace tumble::scenarios {

// seeds are 64 bit unsigned, kept as the signed number of the same bits. A rejected draw is an outcome with kind and
// method empty and status 'rejected'. The view has a row for each score, and one with a null metric for an outcome
// without any.
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
  status TEXT NOT NULL CHECK (status IN ('ok', 'diverged', 'failed', 'crashed', 'timeout', 'rejected')),
  message TEXT NOT NULL,
  recording_digest TEXT NOT NULL,
  estimate_digest TEXT NOT NULL,
  UNIQUE (scenario, seed, kind, method)
);

CREATE TABLE score_values (
  outcome INTEGER NOT NULL REFERENCES outcomes (id) ON DELETE CASCADE,
  metric TEXT NOT NULL,
  value REAL,
  PRIMARY KEY (outcome, metric)
) WITHOUT ROWID;

CREATE VIEW scores AS
  SELECT o.scenario, o.seed, o.kind, o.method, o.status, s.metric, s.value
  FROM outcomes AS o LEFT JOIN score_values AS s ON s.outcome = o.id;

CREATE TABLE draw_values (
  scenario TEXT NOT NULL,
  seed INTEGER NOT NULL,
  metric TEXT NOT NULL,
  value REAL,
  PRIMARY KEY (scenario, seed, metric)
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

}  // namespace tumble::scenarios
