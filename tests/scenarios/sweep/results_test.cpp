// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/results.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "scenarios/provenance/build_id.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

Outcome sample_outcome(std::uint64_t seed) {
  Outcome outcome;
  outcome.scenario = "hill";
  outcome.seed = seed;
  outcome.kind = Kind::slam;
  outcome.method = "icp";
  outcome.status = OutcomeStatus::ok;
  outcome.scores = {{"ate_m", 0.1 + static_cast<double>(seed)}, {"map_failed", 0.0}};
  outcome.recording_digest = "aa";
  outcome.estimate_digest = "bb";
  return outcome;
}

/// Returns whether there is a plain outcome with these properties.
bool holds(const Results& results, const std::string& scenario, std::uint64_t seed, Kind kind,
           const std::string& method) {
  Outcome key;
  key.scenario = scenario;
  key.seed = seed;
  key.kind = kind;
  key.method = method;
  return results.find(key).has_value();
}

class ResultsTest : public test::TemporaryFolder {
 protected:
  fs::path path() const { return folder_ / "results.db"; }

  std::string complaint(Results::Mode mode) const {
    return test::complaint([&] { Results results(path(), mode); });
  }
};

TEST_F(ResultsTest, DrawsAndCertificatesComeBack) {
  const Certificate certificate{
      build_id(), {{"row", "b", "law", "m", 0.5, 0.0, 1.0, ""}, {"row", "a", "law", "1", 2.0, 0.0, 1.0, "why"}}};
  {
    Results results(path(), Results::Mode::create_or_append);
    results.store(DrawValues{"hill", 3, {{"motion_path_m", 7.5}, {"motion_several_axes_share", std::nan("")}}});
    results.store(DrawValues{"hill", 3, {{"motion_path_m", 8.5}}});
    results.store(certificate);
    results.store(certificate);  // replaces the same certificate
  }
  const Results results(path(), Results::Mode::read_only);
  const std::vector<DrawValues> draws = results.draws();
  ASSERT_EQ(draws.size(), 1u);
  EXPECT_EQ(draws[0].seed, 3u);
  ASSERT_EQ(draws[0].values.size(), 2u);
  EXPECT_EQ(draws[0].values[0].value, 8.5);
  EXPECT_TRUE(std::isnan(draws[0].values[1].value));
  ASSERT_EQ(results.certificates().size(), 1u);
  EXPECT_EQ(results.certificates()[0], certificate);
}

TEST_F(ResultsTest, WhatIsStoredComesBack) {
  const std::uint64_t large = std::numeric_limits<std::uint64_t>::max();
  {
    Results results(path(), Results::Mode::create_or_append);
    results.store(sample_outcome(large));
    Outcome crashed = sample_outcome(7);
    crashed.status = OutcomeStatus::crashed;
    crashed.message = "ended by signal 11";
    crashed.scores.clear();
    results.store(crashed);
    results.store(RejectedDraw{"hill", 9, "left the world"});
    results.set_note("suite", "demo");
  }
  const Results results(path(), Results::Mode::read_only);
  EXPECT_EQ(results.note("suite"), "demo");
  EXPECT_EQ(results.note("build"), build_id());
  EXPECT_EQ(results.note("no such"), "");
  EXPECT_TRUE(holds(results, "hill", large, Kind::slam, "icp"));
  EXPECT_FALSE(holds(results, "hill", large, Kind::rate, "icp"));
  ASSERT_EQ(results.outcomes().size(), 2u);
  ASSERT_EQ(results.rejected().size(), 1u);
  EXPECT_EQ(results.rejected().front().seed, 9u);
  EXPECT_EQ(results.rejected().front().message, "left the world");

  // there is one row per score, one for the outcome without scores, and one for the rejected draw
  int ok = 0;
  int crashed = 0;
  int rejected = 0;
  for (const ScoreRow& row : results.scores()) {
    if (row.status == OutcomeStatus::ok) {
      ++ok;
      EXPECT_EQ(row.seed, large);
      if (row.metric == "ate_m") {
        EXPECT_EQ(row.value, 0.1 + static_cast<double>(large));
      }
    } else if (row.status == OutcomeStatus::crashed) {
      ++crashed;
      EXPECT_EQ(row.metric, "");
      EXPECT_TRUE(std::isnan(row.value));
    } else {
      ++rejected;
      EXPECT_EQ(row.status, OutcomeStatus::rejected);
      EXPECT_EQ(row.kind, "");
    }
  }
  EXPECT_EQ(ok, 2);
  EXPECT_EQ(crashed, 1);
  EXPECT_EQ(rejected, 1);
}

TEST_F(ResultsTest, StoringAgainReplacesTheRowAndItsScores) {
  Results results(path(), Results::Mode::create_or_append);
  results.store(sample_outcome(1));
  Outcome again = sample_outcome(1);
  again.scores = {{"ate_m", 5.0}};
  results.store(again);
  ASSERT_EQ(results.outcomes().size(), 1u);
  ASSERT_EQ(results.scores().size(), 1u);
  EXPECT_EQ(results.scores().front().value, 5.0);
  SQLite::Database raw(path().string());
  EXPECT_EQ(raw.execAndGet("SELECT count(*) FROM score_values").getInt(), 1)
      << "scores of the replaced row stay behind";
}

TEST_F(ResultsTest, NaNAndInfinityAreKept) {
  Results results(path(), Results::Mode::create_or_append);
  Outcome outcome = sample_outcome(1);
  outcome.scores = {{"a", std::nan("")}, {"b", std::numeric_limits<double>::infinity()}};
  results.store(outcome);
  ASSERT_EQ(results.scores().size(), 2u);
  EXPECT_TRUE(std::isnan(results.scores()[0].value));
  EXPECT_EQ(results.scores()[1].value, std::numeric_limits<double>::infinity());
}

// SQLite accepts text in a number's column and returns it as 0
TEST_F(ResultsTest, AValueThatIsNoNumberIsNamed) {
  {
    Results results(path(), Results::Mode::create_or_append);
    results.store(sample_outcome(1));
    results.store(DrawValues{"hill", 1, {{"motion_path_m", 2.0}}, {}});
    results.store(Certificate{"b", {{"drop", "ball", "law", "m", 1.0, 0.0, 2.0, ""}}});
  }
  const auto reading = [&](const char* change, const auto& read) -> std::string {
    SQLite::Database(path().string(), SQLite::OPEN_READWRITE).exec(change);
    return test::complaint([&] { read(Results(path(), Results::Mode::read_only)); });
  };
  const auto scores = [](const Results& results) { results.scores(); };
  const auto each = [](const Results& results) {
    Names names;
    results.each(Rows::all, names, [](const OutcomeView&) {});
  };
  const auto draws = [](const Results& results) { results.draws(); };
  const auto certificates = [](const Results& results) { results.certificates(); };
  const std::string at = path().string() + ": hill, seed 1, slam/icp, ate_m: ";
  for (const auto& [value, is] : {std::pair{"'good'", "is text"}, {"x'00ff'", "is a blob"}, {"''", "is text"}}) {
    const std::string change = std::string("UPDATE score_values SET value = ") + value + " WHERE metric = 'ate_m'";
    EXPECT_EQ(reading(change.c_str(), scores), at + is + "; it must be a number or null");
    EXPECT_EQ(reading(change.c_str(), each), at + is + "; it must be a number or null");
  }
  EXPECT_EQ(reading("UPDATE score_values SET value = '3'", each), "") << "SQLite makes a number of it";
  EXPECT_EQ(reading("UPDATE score_values SET value = NULL", each), "");
  EXPECT_EQ(reading("UPDATE draw_values SET value = 'far'", draws),
            path().string() + ": hill, seed 1, motion_path_m: is text; it must be a number or null");
  EXPECT_EQ(reading("UPDATE certificates SET high = 'high'", certificates),
            path().string() + ": certificate, drop: is text; it must be a number or null");
}

TEST_F(ResultsTest, WhatTheSchemaHasIsThereOrNamed) {
  { Results(path(), Results::Mode::create_or_append).store(sample_outcome(1)); }
  const std::string whole = test::read_file(path());
  for (const auto& [change, missing] :
       {std::pair{"DROP TABLE score_values", "table score_values"},
        {"DROP TABLE notes", "table notes"},
        {"DROP VIEW curves", "view curves"},
        {"DROP VIEW scores; DROP VIEW curves; ALTER TABLE outcomes DROP COLUMN message",
         "column message of table outcomes"},
        {"ALTER TABLE draw_values RENAME COLUMN metric TO name", "column metric of table draw_values"}}) {
    write("results.db", whole);
    SQLite::Database(path().string(), SQLite::OPEN_READWRITE)
        .exec(std::string("PRAGMA legacy_alter_table = ON;") + change);
    const std::string says =
        path().string() + ": the file is not a usable results database, because it lacks " + missing;
    EXPECT_EQ(complaint(Results::Mode::read_only), says);
    EXPECT_EQ(complaint(Results::Mode::create_or_append), says);
  }
  write("results.db", whole);
  EXPECT_EQ(complaint(Results::Mode::read_only), "");
}

TEST_F(ResultsTest, AnotherBuildMayReadButNotAppend) {
  {
    Results results(path(), Results::Mode::create_or_append);
    results.store(sample_outcome(1));
    results.set_note("build", "0.0.0 somebody else's");
  }
  EXPECT_EQ(complaint(Results::Mode::read_only), "");
  const std::string text = complaint(Results::Mode::create_or_append);
  EXPECT_NE(text.find(path().string()), std::string::npos);
  EXPECT_NE(text.find("written by build '0.0.0 somebody else's'"), std::string::npos) << text;
}

TEST_F(ResultsTest, OtherFilesAreRefusedAndLeftAlone) {
  EXPECT_NE(complaint(Results::Mode::read_only).find("no such file"), std::string::npos);
  EXPECT_FALSE(fs::exists(path()));

  write("results.db",
        "this is no database, whatever its name says; it is long enough to have a header of 100 bytes .....");
  EXPECT_NE(complaint(Results::Mode::read_only).find("not a"), std::string::npos);
  EXPECT_NE(complaint(Results::Mode::create_or_append).find("not a"), std::string::npos);

  fs::remove(path());
  { SQLite::Database(path().string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE).exec("CREATE TABLE theirs (x)"); }
  EXPECT_NE(complaint(Results::Mode::create_or_append).find("not a results database"), std::string::npos);
  SQLite::Database theirs(path().string());
  EXPECT_EQ(theirs.execAndGet("SELECT count(*) FROM sqlite_master").getInt(), 1);
}

TEST_F(ResultsTest, ATruncatedDatabaseIsBadInput) {
  {
    Results results(path(), Results::Mode::create_or_append);
    for (std::uint64_t seed = 0; seed < 200; ++seed) results.store(sample_outcome(seed));
  }
  fs::resize_file(path(), fs::file_size(path()) / 2);
  EXPECT_THROW(
      {
        const Results results(path(), Results::Mode::read_only);
        results.scores();
      },
      BadInput);
}

// opening a pipe would wait for ever
TEST_F(ResultsTest, APipeAndAFolderAreRefused) {
  for (const bool pipe : {true, false}) {
    fs::remove(path());
    ASSERT_EQ(pipe ? mkfifo(path().c_str(), 0600) : mkdir(path().c_str(), 0700), 0);
    for (const Results::Mode mode : {Results::Mode::read_only, Results::Mode::create_or_append})
      EXPECT_NE(complaint(mode).find(pipe ? "is a pipe; it must be a regular file" : "is a folder; it must be a file"),
                std::string::npos)
          << complaint(mode);
  }
}

TEST_F(ResultsTest, SaysWhetherItHoldsRows) {
  Results results(path(), Results::Mode::create_or_append);
  results.set_note("suite", "roll");
  EXPECT_FALSE(results.has_rows());
  results.store(RejectedDraw{"hill", 3, "cannot be drawn", {}});
  EXPECT_TRUE(results.has_rows());
}

TEST_F(ResultsTest, AFolderThatIsNotThereIsBadInput) {
  EXPECT_THROW(Results(folder_ / "no" / "such" / "results.db", Results::Mode::create_or_append), BadInput);
}

TEST_F(ResultsTest, NoRoomIsBadInputAndWhatWasStoredStays) {
  Results results(path(), Results::Mode::create_or_append);
  results.store(sample_outcome(1));
  // a limit on the size of files simulates a full disk; the test ignores its signal because the error tells more
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{40960, 40960};
    setrlimit(RLIMIT_FSIZE, &limit);
    int code = 1;
    try {
      Results full(path(), Results::Mode::create_or_append);
      for (std::uint64_t seed = 2; seed < 2000; ++seed) full.store(sample_outcome(seed));
    } catch (const BadInput& error) {
      code = std::string(error.what()).starts_with(path().string()) ? 0 : 2;
    }
    _exit(code);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_TRUE(holds(Results(path(), Results::Mode::read_only), "hill", 1, Kind::slam, "icp"));
}

// a writer is killed during its work: all that it had stored is there and the database is intact
TEST_F(ResultsTest, WhatHasBeenStoredSurvivesAKill) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    close(ends[0]);
    Results results(path(), Results::Mode::create_or_append);
    for (std::uint64_t seed = 1;; ++seed) {
      results.store(sample_outcome(seed));
      if (::write(ends[1], &seed, sizeof(seed)) != sizeof(seed)) _exit(1);
    }
  }
  close(ends[1]);
  std::uint64_t stored = 0;
  while (stored < 20 && read(ends[0], &stored, sizeof(stored)) == sizeof(stored)) continue;
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  while (read(ends[0], &stored, sizeof(stored)) == sizeof(stored)) continue;
  close(ends[0]);
  ASSERT_GE(stored, 20u);
  Results results(path(), Results::Mode::create_or_append);
  EXPECT_GE(results.outcomes().size(), stored);
  for (std::uint64_t seed = 1; seed <= stored; ++seed)
    EXPECT_TRUE(holds(results, "hill", seed, Kind::slam, "icp")) << seed;
  EXPECT_EQ(results.scores().size(), 2 * results.outcomes().size());
}

// a copy of the files during a large transaction is what a killed writer leaves
TEST_F(ResultsTest, ReadersRollBackTheTransactionOfAKilledWriter) {
  Results(path(), Results::Mode::create_or_append).store(sample_outcome(1));
  const fs::path killed = folder_ / "killed.db";
  {
    SQLite::Database writer(path().string(), SQLite::OPEN_READWRITE);
    writer.exec("PRAGMA cache_size = 1");  // changed pages are written before the end of the transaction
    SQLite::Transaction transaction(writer);
    SQLite::Statement insert(writer, "INSERT INTO notes VALUES (?, ?)");
    for (int k = 0; k < 200; ++k) {
      insert.bind(1, "key " + std::to_string(k));
      insert.bind(2, std::string(1000, 'x'));
      insert.exec();
      insert.reset();
    }
    fs::copy_file(path(), killed);
    fs::copy_file(path().string() + "-journal", killed.string() + "-journal");
  }
  const Results results(killed, Results::Mode::read_only);
  EXPECT_EQ(results.note("key 0"), "");
  EXPECT_TRUE(holds(results, "hill", 1, Kind::slam, "icp"));
}

}  // namespace
}  // namespace tumble::scenarios
