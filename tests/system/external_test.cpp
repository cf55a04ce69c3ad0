// SPDX-License-Identifier: BSD-3-Clause
// The test runs an external command in run and sweep: its answers are scored like those of the project's methods, and
// its faults are outcomes.
#include <unistd.h>

#include <csignal>

#include "scenarios/sweep/results.hpp"
#include "system/program.hpp"

namespace tumble::system_test {
namespace {

std::string example() {
  return (test::source_dir() / "examples" / "methods" / "raw.yaml").string();
}

std::string describe(const fs::path& folder, const std::string& name, const std::string& script,
                     const std::string& more = "") {
  const fs::path file = folder / (name + ".yaml");
  std::ofstream(file) << "name: " << name << "\nkind: rate\ncommand: [sh, -c, '" << script << " # {output}']\n" << more;
  return file.string();
}

/// Returns metric -> value, without costs.
std::map<std::string, double> scores_of(const json& document, const std::string& method) {
  std::map<std::string, double> out;
  for (const json& row : document["scores"]) {
    if (row["method"] != method) continue;
    const std::string metric = row["metric"];
    if (!metric.ends_with("_cpu_s") && !metric.ends_with("_mib") && row["value"].is_number())
      out[metric] = row["value"];
  }
  return out;
}

TEST(External, ExampleScoresAsOursDoes) {
  const json document = json_of(run_program(
      {"run", shared_scenario("hill"), "--seed", "1", "--method", "rate/raw", "--method", example(), "--json"}));
  const auto ours = scores_of(document, "raw"), theirs = scores_of(document, "raw_python");
  ASSERT_TRUE(ours.contains("rate_error_clipped_median_rad_s"));
  for (const char* metric : {"rate_error_clipped_median_rad_s", "rate_error_clipped_p99_rad_s"})
    EXPECT_EQ(theirs.at(metric), ours.at(metric)) << metric;
}

TEST(External, WhatGoesWrongIsAnOutcomeOfTheSweep) {
  const fs::path folder = test_folder();
  const std::vector<std::string> sweep = {"sweep",      "hill",
                                          "--seeds",    "1..1",
                                          "--method",   "rate/raw",
                                          "--method",   describe(folder, "crashes", "kill -SEGV $$"),
                                          "--method",   describe(folder, "hangs", "sleep 600", "time_limit_s: 1\n"),
                                          "--method",   describe(folder, "silent", "true"),
                                          "--examples", "0",
                                          "--db",       (folder / "out.db").string()};
  run_successfully(sweep, in_short_catalogue());
  std::map<std::string, std::string> status;
  {
    const scenarios::Results results(folder / "out.db", scenarios::Results::Mode::read_only);
    for (const scenarios::Outcome& outcome : results.outcomes()) status[outcome.method] = to_string(outcome.status);
  }
  EXPECT_EQ(status, (std::map<std::string, std::string>{
                        {"raw", "ok"}, {"crashes", "crashed"}, {"hangs", "timeout"}, {"silent", "failed"}}));

  // another method has the name of one for which the database has rows
  describe(folder, "silent", "false");
  const Ended other = run_program(sweep, in_short_catalogue());
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("rate/silent"));
}

// whether the method hangs when it is imported or when it runs, no file of it remains after the user stops it
TEST(External, AHangThatIsStoppedLeavesNoFolder) {
  const fs::path folder = test_folder();
  std::ofstream(folder / "small.yaml") << "name: small\ndoc: a draw\nmethods: [rate/raw]\ntimeout_s: 600\n"
                                          "draws: {one: {hill: [1]}}\n";
  const std::string hangs = describe(folder, "hangs", "touch started; exec sleep 600");
  const std::vector<std::string> verbs[] = {
      {"bench", hangs, "--suite", (folder / "small.yaml").string(), "--db", (folder / "b.db").string()},
      {"triage", shared_scenario("hill"), "--seed", "1", "--method", hangs},
      {"run", shared_scenario("hill"), "--seed", "1", "--method", hangs}};
  for (const std::vector<std::string>& verb : verbs) {
    const fs::path temporary = folder / (verb.front() + "_temporary");
    fs::create_directory(temporary);
    const auto has_started = [&] {
      std::error_code gone;
      for (const fs::directory_entry& each : fs::recursive_directory_iterator(temporary, gone))
        if (each.path().filename() == "started") return true;
      return false;
    };
    Running running(verb, [&, short_catalogue = in_short_catalogue()] {
      short_catalogue();
      setenv("TMPDIR", temporary.c_str(), 1);
    });
    while (!has_started() && !running.has_ended()) usleep(1000);
    EXPECT_FALSE(running.has_ended()) << verb.front();
    running.signal(SIGINT);
    const Ended ended = running.wait();
    EXPECT_NE(ended.status, 0) << verb.front();
    EXPECT_TRUE(fs::is_empty(temporary)) << verb.front() << " left " << *fs::directory_iterator(temporary);
    if (verb.front() == "run") {
      EXPECT_THAT(ended.err, HasSubstr("hangs.yaml: the program stops each run of this method after 600 s"))
          << ended.err;
    }
  }
}

TEST(External, AGateHoldsItToItsAcceptedRun) {
  const fs::path folder = test_folder();
  std::ofstream(folder / "small.yaml") << "name: small\ndoc: a draw\nscenarios: [hill]\nseeds: {first: 1, last: 1}\n";
  const std::vector<std::string> gate = {
      "gate", (folder / "small.yaml").string(), "--against", (folder / "g.yaml").string(), "--quiet", "--json"};
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = gate;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments, in_short_catalogue());
  };
  Ended ended = run({"--method", example(), "--accept"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(read_file(folder / "g.csv"), HasSubstr("hill,rate,raw_python,status,ok"));
  ended = run({"--method", example()});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_GE(json_of(ended)["held"].size(), 2u);
  for (const json& row : json_of(ended)["held"]) EXPECT_EQ(row["method"], "raw_python") << "the file's alone";

  ended = run({});
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.err, HasSubstr("--method FILE.yaml"));
  ended = run({"--method", example(), "--method", describe(folder, "other", "true")});
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.err, HasSubstr("rate/other"));
  ended = run({"--method", "rate/raw"});
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.err, HasSubstr("give a FILE.yaml"));

  // negative control: the command of that name now answers nothing
  ended = run({"--method", describe(folder, "raw_python", "true")});
  EXPECT_EQ(ended.status, 1) << ended.err;
  EXPECT_EQ(json::parse(ended.out)["verdict"], "fail");
}

}  // namespace
}  // namespace tumble::system_test
