// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/results_schema.hpp"

namespace tumble::scenarios {

// seeds are 64 bit unsigned, kept as the signed number of the same bits. A rejected draw is an outcome with kind and
// method empty and status 'rejected'. The view has a row for each score, and one with a null metric for an outcome
// without any. A point of a curve carries in `varied` the keys and in `setting` their value; `varied` is empty for the
// scenario and the methods as they are, and only those are in the view `scores`: points of curves are in `curves`.
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

}  // namespace tumble::scenarios
