// SPDX-License-Identifier: BSD-3-Clause
// Sweeps that are stopped and resumed, shards and their merge, the report.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <fstream>
#include <thread>

#include "scenarios/sweep/results.hpp"
#include "system/program.hpp"

namespace tumble::system_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

Ended run(const std::vector<std::string>& arguments) {
  return run_program(arguments, in_short_catalogue());
}

/// The sweep that these tests share: short draws of the sphere.
std::vector<std::string> sweep_arguments(const fs::path& database, const std::string& seeds,
                                         const std::string& examples = "0") {
  return {"sweep",   "roll", "--seeds", seeds,        "--method", "rate/raw", "--method",
          "rolling", "--db", database,  "--examples", examples,   "--json"};
}

/// A page up to the Plotly bundle, which holds pictures and addresses of its own.
std::string own_part(const fs::path& page) {
  const std::string text = read_file(page);
  return text.substr(0, text.find("<script id=\"plotly\">"));
}

json report_json(const fs::path& database) {
  return json_of(run({"report", database.string(), "--json"}));
}

/// The scores of a report without what they cost.
json comparable(json report) {
  for (json& row : report["scores"]) {
    for (const char* cost : {"estimate_cpu_s", "simulate_cpu_s", "estimate_peak_mib"}) row["metrics"].erase(cost);
  }
  return report;
}

TEST(Sweep, InterruptedKeepsWhatIsDoneAndGoesOn) {
  const fs::path folder = test_folder();
  const fs::path database = folder / "stopped.db";
  // far more draws than end before the signal
  std::vector<std::string> arguments = sweep_arguments(database, "1..500");
  arguments.insert(arguments.end(), {"--jobs", "1"});
  Running running(arguments, in_short_catalogue());
  // one draw at a time: outcomes of a second draw say that the first is complete; they give the signal, however fast
  // the machine is
  for (int i = 0; i < 1200 && !running.has_ended(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (!fs::exists(database)) continue;
    const Ended report = run({"report", database.string(), "--json"});
    if (report.status == 0 && json_of(report)["draws"]["roll"] >= 2) break;
  }
  ASSERT_FALSE(running.has_ended()) << running.wait().err;
  running.signal(SIGINT);
  const Ended stopped = running.wait();
  EXPECT_EQ(stopped.status, 1) << stopped.err;
  EXPECT_THAT(stopped.err, HasSubstr("stopped: "));
  EXPECT_THAT(stopped.err, HasSubstr(" of 500 draws stored, run again to go on"));

  const std::int64_t kept = report_json(database)["draws"]["roll"];
  ASSERT_GE(kept, 1);
  ASSERT_LT(kept, 500);

  // going on over the seeds that are there is no work, and changes nothing
  const std::int64_t done = json_of(stopped)["draws_done"];
  ASSERT_GE(done, 1);
  const Ended resumed = run(sweep_arguments(database, "1.." + std::to_string(done + 1)));
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  EXPECT_EQ(json_of(resumed)["draws_done"], done + 1);
  EXPECT_LE(json_of(resumed)["outcomes"], 4) << "what was stored is not run again";

  // the same seeds in one go give the same scores
  const fs::path whole = folder / "whole.db";
  ASSERT_EQ(run(sweep_arguments(whole, "1.." + std::to_string(done + 1))).status, 0);
  EXPECT_EQ(comparable(report_json(database)), comparable(report_json(whole)));
}

TEST(Sweep, ShardsMergeToTheWhole) {
  const fs::path folder = test_folder();
  std::vector<std::string> merge = {"merge", (folder / "merged.db").string()};
  for (const char* shard : {"1/2", "2/2"}) {
    const fs::path database = folder / (std::string(1, shard[0]) + ".db");
    std::vector<std::string> arguments = sweep_arguments(database, "1..3");
    arguments.insert(arguments.end(), {"--shard", shard});
    ASSERT_EQ(run(arguments).status, 0);
    merge.push_back(database.string());
  }
  const Ended merged = run(merge);
  ASSERT_EQ(merged.status, 0) << merged.err;
  ASSERT_EQ(run(sweep_arguments(folder / "whole.db", "1..3")).status, 0);
  const json report = comparable(report_json(folder / "merged.db"));
  EXPECT_EQ(report["draws"]["roll"], 3);
  EXPECT_EQ(report, comparable(report_json(folder / "whole.db")));
}

TEST(Sweep, OffATerminalWritesNoControlCharacters) {
  const Ended ended = run(sweep_arguments(test_folder() / "x.db", "1"));
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.err, Not(HasSubstr("\r")));
  EXPECT_THAT(ended.err, Not(HasSubstr("\x1b")));
  EXPECT_THAT(ended.err, HasSubstr("1/1 draws"));
  std::vector<std::string> quiet = sweep_arguments(test_folder() / "x.db", "1");
  quiet.push_back("--quiet");
  EXPECT_EQ(run(quiet).err, "");
}

// what is kept is what `tumble run` leaves: other verbs read it
TEST(Sweep, KeepsDrawsThatOtherVerbsRead) {
  const fs::path folder = test_folder();
  std::vector<std::string> arguments = sweep_arguments(folder / "k.db", "1..2");
  arguments.insert(arguments.end(), {"--keep", "worst:1"});
  const Ended ended = run(arguments);
  ASSERT_EQ(ended.status, 0) << ended.err;
  const json swept = json_of(ended);
  EXPECT_GE(swept["kept"], 1);
  EXPECT_EQ(swept["kept"], swept["to_keep"]);
  EXPECT_GT(swept["peak_mib"], 1.0);
  EXPECT_THAT(ended.err, HasSubstr("k.db.files/kept/SCENARIO/SEED"));
  const fs::path kept = folder / "k.db.files" / "kept" / "roll";
  const fs::path draw = fs::directory_iterator(kept)->path();
  EXPECT_THAT(read_file(draw / "command"), HasSubstr("tumble run roll --seed " + draw.filename().string()));
  const Ended scored =
      run({"score", (draw / "estimates" / "position-rolling").string(), (draw / "recording.h5").string(), "--json"});
  EXPECT_EQ(scored.status, 0) << scored.err;
}

// a part without a draw does not keep the merge from keeping what the others have
TEST(Sweep, AShardWithoutSeedsKeepsByTheRuleOfTheOthers) {
  const fs::path folder = test_folder();
  std::vector<std::string> merge = {"merge", "--json", (folder / "merged.db").string()};
  for (const char* shard : {"1/2", "2/2"}) {
    merge.push_back((folder / (std::string(1, shard[0]) + ".db")).string());
    std::vector<std::string> arguments = sweep_arguments(merge.back(), "1");
    arguments.insert(arguments.end(), {"--shard", shard, "--keep", "all"});
    ASSERT_EQ(run(arguments).status, 0);
  }
  const Ended merged = run(merge);
  ASSERT_EQ(merged.status, 0) << merged.err;
  EXPECT_EQ(json_of(merged)["kept"], 1);
}

// 'slip' is a suite, and a scenario of it
TEST(Sweep, OfASuiteSomeScenariosAlone) {
  const fs::path folder = test_folder(), database = folder / "a.db";
  const std::vector<std::string> words = {"sweep", "slip",   "--seeds",    "1", "--method", "rate/raw",
                                          "--db",  database, "--examples", "0", "--json"};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = words;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  };
  const Ended one = with({"--scenario", "roll"});
  EXPECT_EQ(one.status, 0) << one.err;
  EXPECT_EQ(json_of(one)["draws_total"], 1);
  EXPECT_THAT(one.err, Not(HasSubstr("for that one alone")));
  EXPECT_EQ(report_json(database)["draws"], (json{{"roll", 1}}));
  const Ended unknown = with({"--scenario", "slib"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("unknown scenario of suite 'slip' 'slib'"));
  const Ended all = with({"--shard", "2/2"});  // which has nothing to do
  EXPECT_EQ(all.status, 0) << all.err;
  EXPECT_THAT(all.err, HasSubstr("--scenario slip for that one alone"));
}

// seeds in a row are asked for where a suite has but some of them
TEST(Sweep, NamedDrawsAreNoSeedsInARow) {
  const fs::path folder = test_folder(), suite = folder / "named.yaml";
  std::ofstream(suite) << "name: named\ndoc: d\nmethods: [rate/raw, rate/saave]\ndraws: {mild: {roll: [3, 8]}}\n";
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& what) {
    const Ended ended = run(arguments);
    EXPECT_EQ(ended.status, 2) << what;
    EXPECT_THAT(ended.err, HasSubstr(what));
    EXPECT_THAT(ended.err, HasSubstr("names its draws"));
  };
  const std::string database = (folder / "x.db").string();
  refused({"sweep", suite.string(), "--db", database, "--until", "rate/raw:rate/saave:rate_error_clipped_median_rad_s"},
          "--until");
  refused({"triage", suite.string(), "--method", "rate/raw", "--seeds", "1..2"}, "--seeds");
  refused({"sweep", suite.string(), "--db", database, "--scenario", "roll"}, "--scenario");
  refused({"gate", suite.string(), "--against", (folder / "g.yaml").string(), "--accept"}, "a gate holds");
}

TEST(Sweep, RefusesWhatItCannotKeepOrAsk) {
  const fs::path database = test_folder() / "x.db";
  const auto refused = [&](const std::vector<std::string>& more, const std::string& what) {
    std::vector<std::string> arguments = sweep_arguments(database, "1");
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Ended ended = run(arguments);
    EXPECT_EQ(ended.status, 2) << what;
    EXPECT_THAT(ended.err, HasSubstr(what));
  };
  refused({"--keep", "worst:0"}, "worst:N with N from 1 to 1000");
  refused({"--memory", "1"}, "--memory");
  refused({"--memory", "nan"}, "--memory");
  refused({"--until", "rate/raw:rate/tumble"}, "must be A:B:METRIC");
  refused({"--until", "rate/raw:rate/tumble:rate_error_clipped_median_rad_s"}, "method of the suite");
  refused({"--until", "rate/raw:rate/raw:rate_error_clipped_median_rad_s", "--shard", "1/2"}, "a shard has no looks");
}

TEST(Report, IsOnePageThatAsksTheNetworkNothing) {
  const fs::path folder = test_folder();
  const fs::path database = folder / "r.db", page = folder / "report.html";
  ASSERT_EQ(run(sweep_arguments(database, "1..2", "1")).status, 0);
  const Ended ended = run({"report", database.string(), "-o", page.string()});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("position_end_error_share"));

  std::string text = read_file(page);
  const std::size_t bundle = text.find("<script id=\"plotly\">");
  ASSERT_NE(bundle, std::string::npos);
  const std::size_t end = text.find("</script>", bundle);
  EXPECT_GT(end - bundle, 1000000u) << "the Plotly bundle is inside";
  text.erase(bundle, end - bundle);
  // the bundle holds addresses as text; nothing else of the page may, and nothing may be fetched
  for (const char* outside : {"http:", "https:", "@import", "url(", "<link"})
    EXPECT_THAT(text, Not(HasSubstr(outside)));
  EXPECT_THAT(text, HasSubstr("data:image/png;base64,iVBORw0KGgo")) << "no picture";
  EXPECT_THAT(text, HasSubstr("data:image/webp;base64,UklGR")) << "nothing moves";
  EXPECT_THAT(text, HasSubstr("rolling"));
  EXPECT_THAT(text, HasSubstr("id=\"path-roll-"));
  for (const char* part :
       {"id=\"certificate\"", "free_flight_energy", "id=\"motions\"", "distribution-motion_path_m"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
  const json document = report_json(database);
  ASSERT_EQ(document["certificates"].size(), 1u);
  EXPECT_EQ(document["certificates"][0]["verdict"], "pass");
  EXPECT_FALSE(document["motions"].empty());
}

TEST(Report, IsAFunctionOfWhatASweepHasLeft) {
  const fs::path folder = test_folder();
  const fs::path database = folder / "r.db", page = folder / "report.html";
  const fs::path list = folder / "r.db.files" / "examples.json";
  ASSERT_EQ(run(sweep_arguments(database, "1..2")).status, 0);
  EXPECT_FALSE(fs::exists(list)) << "none were asked for";
  std::vector<std::string> untold = sweep_arguments(database, "1..2");
  untold.erase(std::find(untold.begin(), untold.end(), "--examples"), untold.end() - 1);
  ASSERT_EQ(run(untold).status, 0);
  EXPECT_FALSE(fs::exists(list)) << "two draws do not pay for an example";
  const std::vector<std::string> report = {"report", database.string(), "-o", page.string()};
  Ended ended = run(report);
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(own_part(page), Not(HasSubstr("data:image/png;base64,iVBORw0KGgo")));
  EXPECT_THAT(own_part(page), HasSubstr("tumble sweep roll --seeds 1..2 --method rate/raw --method rolling --db "))
      << "it says what makes them";
  EXPECT_THAT(own_part(page), HasSubstr("r.db --examples 3")) << "so few draws get none unless told";
  EXPECT_THAT(ended.err, HasSubstr("No pictures of single draws"));

  // a sweep of this build would be refused by results of another one: then that is named instead
  {
    scenarios::Results results(database, scenarios::Results::Mode::create_or_append);
    const auto page_where = [&](const std::string& key, const std::string& text) {
      const std::string as_it_was = results.note(key);
      results.set_note(key, text);
      EXPECT_EQ(run(report).status, 0);
      results.set_note(key, as_it_was);
      return own_part(page);
    };
    const std::string foreign = page_where("build", "another build"), mixed = page_where("build", "mixed");
    EXPECT_THAT(foreign, HasSubstr("by the build that made these results (another build)"));
    EXPECT_THAT(foreign, Not(HasSubstr("tumble sweep roll")));
    EXPECT_THAT(mixed, HasSubstr("of several builds"));
    EXPECT_THAT(mixed, Not(HasSubstr("tumble sweep roll")));
    const std::string elsewhere = page_where("data", "other data");
    EXPECT_THAT(elsewhere, HasSubstr("(digest other data)"));
    EXPECT_THAT(elsewhere, Not(HasSubstr("tumble sweep roll")));
  }

  // they are made of what is there: nothing runs again but the draw that is shown
  ended = run(sweep_arguments(database, "1..2", "1"));
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(json_of(ended)["outcomes"], 0);
  EXPECT_THAT(ended.err, HasSubstr("running it again for its pictures"));
  const std::string left = read_file(list);
  ended = run(sweep_arguments(database, "1..2", "1"));
  EXPECT_THAT(ended.err, Not(HasSubstr("running it again"))) << "they are there already";
  EXPECT_EQ(read_file(list), left);

  ASSERT_EQ(run(report).status, 0);
  EXPECT_THAT(own_part(page), HasSubstr("the same digest as in the results"));
  std::ofstream(list) << "damaged";
  ended = run(report);
  EXPECT_EQ(ended.status, 0) << "the scores are there all the same";
  EXPECT_THAT(own_part(page), HasSubstr("examples.json"));
}

// the lidar's library said of too little memory that the CPU was too old
TEST(Sweep, ADrawWithoutMemoryIsKilledAndBlamesNothingElse) {
  std::vector<std::string> arguments = sweep_arguments(test_folder() / "m.db", "1..1");
  arguments.insert(arguments.end(), {"--memory", "110", "--method", "position/tumble"});
  const json swept = json_of(run(arguments));
  EXPECT_EQ(swept["failures"], (json{{"killed", swept["outcomes"]}})) << swept;
}

TEST(Report, ShowsDrawsThatFailedWhereItTellsOfThem) {
  const fs::path folder = test_folder();
  const fs::path database = folder / "f.db", page = folder / "report.html";
  std::ofstream(folder / "lost.yaml") << "name: lost\nkind: position\ncommand: [sh, -c, 'exit 3 # {output}']\n";
  std::vector<std::string> arguments = sweep_arguments(database, "1..3", "1");
  arguments.insert(arguments.end(), {"--method", (folder / "lost.yaml").string(), "--failures", "2"});
  const Ended ended = run(arguments);
  ASSERT_EQ(ended.status, 0) << ended.err;
  const json left = json::parse(read_file(folder / "f.db.files" / "examples.json"));
  // the typical one, and of the first two that failed what it is not
  ASSERT_GE(left["examples"].size(), 2u) << ended.err;
  const json& failed = left["examples"].back();
  EXPECT_FALSE(left["examples"][0]["of_failure"]);
  EXPECT_TRUE(failed["of_failure"]);
  EXPECT_EQ(failed["pictures"].size(), 1u);
  EXPECT_TRUE(failed["plots"].empty());
  EXPECT_TRUE(fs::exists(folder / "f.db.files" / failed["replay"].get<std::string>()));
  ASSERT_EQ(run({"report", database.string(), "-o", page.string()}).status, 0);
  const std::string text = own_part(page), seed = std::to_string(failed["seed"].get<int>());
  EXPECT_THAT(text, HasSubstr("<details id=\"draw-roll-" + seed + "\"><summary>picture</summary>"));
  EXPECT_THAT(text, HasSubstr("<a href=\"f.db.files/" + failed["replay"].get<std::string>() + "\">replay</a>"));
  EXPECT_THAT(text, Not(HasSubstr("made of other results")));
}

TEST(Sweep, OfAnotherSuiteKeepsTheExamplesThatStandThere) {
  const fs::path folder = test_folder();
  const fs::path database = folder / "s.db", list = folder / "s.db.files" / "examples.json";
  std::vector<std::string> arguments = sweep_arguments(database, "1..2", "1");
  ASSERT_EQ(run(arguments).status, 0);
  json left = json::parse(read_file(list));
  ASSERT_EQ(left["examples"].size(), 1u);
  // as a suite of another scenario would have left it
  left["examples"][0]["scenario"] = "elsewhere";
  for (json& picture : left["examples"][0]["pictures"]) {
    const std::string name = "elsewhere-1-" + picture["name"].get<std::string>() + ".png";
    fs::copy_file(list.parent_path() / picture["file"].get<std::string>(), list.parent_path() / name);
    picture["file"] = name;
  }
  json& moving = left["examples"][0]["moving"];
  fs::copy_file(list.parent_path() / moving["file"].get<std::string>(), list.parent_path() / "elsewhere-1-moving.webp");
  moving["file"] = "elsewhere-1-moving.webp";
  std::ofstream(list) << left.dump();
  ASSERT_EQ(run(arguments).status, 0);
  const json both = json::parse(read_file(list));
  ASSERT_EQ(both["examples"].size(), 2u);
  EXPECT_EQ(both["examples"][0]["scenario"], "elsewhere");
  EXPECT_EQ(both["examples"][1]["scenario"], "roll");

  // one that is damaged is told and costs the others nothing
  left = both;
  left["examples"].push_back(left["examples"][0]);
  left["examples"][2].erase("motion");
  std::ofstream(list) << left.dump();
  const Ended ended = run(arguments);
  EXPECT_THAT(ended.err, HasSubstr("an example that stood there is left out"));
  EXPECT_THAT(ended.err, HasSubstr("example 3"));
  EXPECT_EQ(json::parse(read_file(list)), both);
  EXPECT_EQ(json::parse(read_file(folder / "s.db.files" / "examples.json.damaged")), left);
}

TEST(Sweep, StoppedAtItsPicturesSaysSoAndLeavesNone) {
  const fs::path folder = test_folder();
  const fs::path database = folder / "s.db", files = folder / "s.db.files";
  Running running(sweep_arguments(database, "1..2", "1"), in_short_catalogue());
  // the folder is made just before the draw runs again
  for (int i = 0; i < 12000 && !running.has_ended() && !fs::exists(files); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ASSERT_TRUE(fs::exists(files));
  running.signal(SIGINT);
  const Ended stopped = running.wait();
  EXPECT_EQ(stopped.status, 1) << stopped.err;
  EXPECT_EQ(json_of(stopped)["draws_done"], 2);
  EXPECT_THAT(stopped.err, HasSubstr("stopped: all draws are stored, their pictures are not made"));
  EXPECT_FALSE(fs::exists(files)) << "nothing came into it";
}

TEST(Sweep, KeepsItsTableWhenPicturesCannotBeLeft) {
  const fs::path folder = test_folder();
  const fs::path database = folder / "s.db";
  std::ofstream(folder / "s.db.files") << "a file where the folder would stand";
  const Ended ended = run(sweep_arguments(database, "1..2", "1"));
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(json_of(ended)["draws_done"], 2);
  EXPECT_THAT(ended.err, HasSubstr("tumble: no pictures of single draws: "));
}

TEST(Report, OfAnAbsentDatabaseMakesNone) {
  const fs::path database = test_folder() / "absent.db";
  const Ended absent = run({"report", database.string()});
  EXPECT_EQ(absent.status, 2);
  EXPECT_EQ(line_count(absent.err), 1u) << absent.err;
  EXPECT_FALSE(fs::exists(database));
}

}  // namespace
}  // namespace tumble::system_test
