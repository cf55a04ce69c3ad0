// SPDX-License-Identifier: BSD-3-Clause
// The test runs one situation from end to end, and stage by stage.
#include <hdf5.h>

#include "system/program.hpp"

namespace tumble::system_test {
namespace {

class OnRobot : public testing::TestWithParam<const char*> {};

json shared_result(const std::string& scenario) {
  return json::parse(read_file(shared_run(scenario) / "out.json"));
}

/// Returns metric -> value of one method, without costs.
std::map<std::string, double> scores_of(const json& document, const std::string& kind, const std::string& method) {
  std::map<std::string, double> out;
  for (const json& row : document["scores"]) {
    const std::string metric = row["metric"];
    if (row["kind"] != kind || row["method"] != method || row["value"].is_null()) continue;
    if (metric.find("_cpu_s") == std::string::npos && metric.find("_mib") == std::string::npos)
      out[metric] = row["value"];
  }
  return out;
}

/// Returns whether the method reads the truth, which the verb `estimate` never opens.
bool needs_truth(const json& outcome) {
  static const json methods = json_of(run_program({"list", "methods", "--json"}));
  for (const json& method : methods) {
    if (method["kind"] == outcome["kind"] && method["name"] == outcome["method"]) return method["needs_truth"];
  }
  ADD_FAILURE() << "not listed: " << outcome;
  return false;
}

/// The project's methods, the oracles and the filters must succeed; published mapping may fail on a hard tumble.
bool must_hold(const json& outcome) {
  const std::string method = outcome["method"];
  if (method.starts_with("tumble") || method.starts_with("oracle")) return true;
  return outcome["kind"] != "slam";
}

TEST_P(OnRobot, RunLeavesEverythingAndScoresIt) {
  const fs::path folder = shared_run(GetParam());
  const json result = shared_result(GetParam());
  for (const json& outcome : result["outcomes"]) {
    // a diverged run is a finding, and scored as one
    if (!must_hold(outcome) && outcome["status"] == "diverged") continue;
    EXPECT_EQ(outcome["status"], "ok") << outcome;
  }
  EXPECT_EQ(result["digest"].get<std::string>().size(), 32u);
  EXPECT_GT(result["scores"].size(), 5u);
  EXPECT_TRUE(fs::exists(folder / "recording.h5"));
  EXPECT_TRUE(fs::exists(folder / "situation.yaml"));
  for (const json& outcome : result["outcomes"]) {
    const fs::path estimate =
        folder / "estimates" / (outcome["kind"].get<std::string>() + "-" + outcome["method"].get<std::string>());
    EXPECT_TRUE(fs::exists(estimate / "estimate.json")) << estimate;
  }
  for (const char* picture : {"scene.png", "film.png"}) {
    EXPECT_THAT(read_file(folder / "snapshots" / picture), StartsWith("\x89PNG")) << picture;
  }
  const std::string replay = read_file(folder / "replay.html");
  EXPECT_THAT(replay, StartsWith("<!DOCTYPE html>"));
  EXPECT_GT(replay.size(), 300'000u);
  EXPECT_LE(replay.size(), 3'000'000u);
}

TEST_P(OnRobot, SameSeedGivesTheSameDigestForAnyThreads) {
  const std::string scenario = shared_scenario(GetParam());
  const auto digests = [&](const char* seed, const char* threads) {
    // only the lidar simulation uses threads; any method will do
    const Ended ended =
        run_successfully({"run", scenario, "--seed", seed, "--threads", threads, "--method", "rate/raw", "--json"});
    const json document = json_of(ended);
    return std::pair{document["digest"].get<std::string>(), document["recording_digest"].get<std::string>()};
  };
  const auto expected = digests("1", "2");
  EXPECT_EQ(digests("1", "1"), expected) << "two threads or one";
  EXPECT_EQ(expected.second, shared_result(GetParam())["recording_digest"]) << "next to several methods or one";
  const auto other = digests("2", "2");
  EXPECT_NE(other.first, expected.first) << "negative control: another seed is another run";
  EXPECT_NE(other.second, expected.second);
}

/// Returns a copy of `recording` without its truth.
fs::path blinded(const fs::path& recording, const fs::path& copy) {
  fs::copy_file(recording, copy);
  const hid_t file = H5Fopen(copy.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  EXPECT_GE(file, 0);
  EXPECT_GE(H5Ldelete(file, "/truth", H5P_DEFAULT), 0);
  EXPECT_GE(H5Fclose(file), 0);
  return copy;
}

// record, estimate and score in sequence give the results of run, although estimate does not receive the truth
TEST_P(OnRobot, StagesAgreeWithRunAndEstimateNeverOpensTheTruth) {
  const fs::path folder = test_folder();
  const fs::path recording = folder / "recording.h5";
  const json whole = shared_result(GetParam());
  const Ended recorded =
      run_successfully({"record", shared_scenario(GetParam()), "--seed", "1", "-o", recording.string(), "--json"});
  EXPECT_EQ(json_of(recorded)["digest"], whole["recording_digest"]);
  const std::string blind = blinded(recording, folder / "blind.h5").string();

  std::size_t estimated_methods = 0, compared = 0;
  for (const json& outcome : whole["outcomes"]) {
    const std::string kind = outcome["kind"], method = outcome["method"], name = kind + "/" + method;
    if (needs_truth(outcome)) continue;
    ++estimated_methods;
    const std::string estimate = (folder / kind / method).string();
    const Ended estimated = run_successfully({"estimate", blind, "--method", name, "-o", estimate, "--json"});
    EXPECT_EQ(json_of(estimated)["digest"], outcome["digest"]) << name;

    const Ended scored = run_successfully({"score", estimate, recording.string(), "--json"});
    const auto own = scores_of(json_of(scored), kind, method), expected = scores_of(whole, kind, method);
    ASSERT_EQ(own.size(), expected.size()) << name;
    for (const auto& [metric, value] : expected) {
      // reading a TUM file normalises a quaternion, so its last bit may differ
      EXPECT_NEAR(own.at(metric), value, 1e-9 * (1.0 + std::abs(value))) << name << " " << metric;
      ++compared;
    }
  }
  EXPECT_GE(estimated_methods, 3u);
  EXPECT_GT(compared, 5u);
  const Ended oracle = run_program({"estimate", blind, "--method", "rate/oracle", "-o", (folder / "o").string()});
  EXPECT_EQ(oracle.status, 2);
  EXPECT_THAT(oracle.err, HasSubstr("needs the truth"));
}

INSTANTIATE_TEST_SUITE_P(Program, OnRobot, testing::Values("hill", "roll"));

TEST(Run, PrintsATablePerKind) {
  const Ended ended =
      run_successfully({"run", shared_scenario("roll"), "--seed", "1", "--method", "rolling", "--method", "rate/raw"});
  EXPECT_THAT(ended.out, HasSubstr("roll, seed 1: rate"));
  EXPECT_THAT(ended.out, HasSubstr("roll, seed 1: position"));
  EXPECT_THAT(ended.out, HasSubstr("position_end_error_share"));
  EXPECT_THAT(ended.out, HasSubstr("digest"));
}

TEST(Render, WritesAPictureOfARecordingWithItsEstimates) {
  const fs::path run = shared_run("roll");
  const fs::path png = test_folder() / "roll.png";
  const Ended ended = run_successfully({"render", (run / "recording.h5").string(),
                                        (run / "estimates" / "position-rolling").string(), "-o", png.string()});
  EXPECT_THAT(read_file(png), StartsWith("\x89PNG"));
  EXPECT_GT(fs::file_size(png), 10000u) << "an empty picture packs to a few kilobytes";
  EXPECT_THAT(ended.out, HasSubstr("truth"));
}

TEST(Render, WritesAFilmStripAndADraw) {
  const fs::path folder = test_folder();
  const Ended film =
      run_successfully({"render", (shared_run("roll") / "recording.h5").string(), "--film", "4", "--columns", "2",
                        "--width", "160", "--height", "120", "-o", (folder / "film.png").string()});
  EXPECT_THAT(read_file(folder / "film.png"), StartsWith("\x89PNG"));
  const Ended draw = run_successfully(
      {"render", "hill", "--seed", "1", "--width", "320", "--height", "240", "-o", (folder / "draw.png").string()});
  EXPECT_THAT(read_file(folder / "draw.png"), StartsWith("\x89PNG"));
}

TEST(Replay, MakesAPageOfARecordingWithItsEstimates) {
  const fs::path run = shared_run("roll");
  const fs::path page = test_folder() / "roll.html";
  const Ended ended =
      run_successfully({"replay", (run / "recording.h5").string(), (run / "estimates" / "position-rolling").string(),
                        (run / "estimates" / "rate-raw").string(), "--points", "5000", "-o", page.string(), "--json"});
  const json said = json_of(ended);
  const std::string html = read_file(page);
  EXPECT_EQ(said["bytes"], html.size());
  EXPECT_EQ(said["points"]["shown"], 5000);
  EXPECT_GT(said["points"]["of"], 5000);
  ASSERT_EQ(said["paths"].size(), 3u);
  EXPECT_EQ(said["paths"][1]["path"], "position/rolling");
  for (const char* held : {"\"title\":\"roll, seed 1\"", "position/rolling", "rate/raw", "actor1.errors"})
    EXPECT_THAT(html, HasSubstr(held));
}

TEST(Replay, RefusesWhatItCannotShow) {
  const fs::path run = shared_run("roll"), folder = test_folder();
  const std::string recording = (run / "recording.h5").string();
  EXPECT_EQ(run_program({"replay", recording, "-o", recording}).status, 2) << "over its input";
  EXPECT_EQ(run_program({"replay", (folder / "absent.h5").string(), "-o", (folder / "a.html").string()}).status, 2);
  const Ended other = run_program({"replay", recording, (shared_run("hill") / "estimates" / "slam-tumble").string(),
                                   "-o", (folder / "a.html").string()});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("another recording"));
  EXPECT_FALSE(fs::exists(folder / "a.html"));
}

TEST(Render, RefusesAnEstimateOfAnotherRecording) {
  const fs::path picture = test_folder() / "a.png";
  const std::string rig = (shared_run("hill") / "estimates" / "slam-tumble").string();
  for (const char* how : {"--map", "--robots=4"}) {
    const Ended other =
        run_program({"render", (shared_run("roll") / "recording.h5").string(), rig, how, "-o", picture.string()});
    EXPECT_EQ(other.status, 2) << how;
    EXPECT_THAT(other.err, HasSubstr("another recording")) << how;
    EXPECT_FALSE(fs::exists(picture)) << how;
  }
}

// the scenario alone is given: seed 1, the project's method next to the baseline, a folder with the scenario's name,
// and the next command
TEST(FirstRun, AScenarioAloneDoesSomethingGood) {
  const fs::path folder = test_folder();
  const auto in_folder = [&](const std::vector<std::string>& words) {
    return run_program(words, [&, short_catalogue = in_short_catalogue()] {
      short_catalogue();
      fs::current_path(folder);
    });
  };
  const Ended ended = in_folder({"run", "roll", "--json"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  const json said = json_of(ended);
  EXPECT_EQ(said["seed"], 1);
  const auto methods = [](const json& document) {
    std::vector<std::string> names;
    for (const json& outcome : document["outcomes"]) names.push_back(outcome["method"]);
    return names;
  };
  EXPECT_THAT(methods(said), ElementsAre("raw", "tumble", "integrate", "tumble", "rolling", "tumble"));
  for (const char* file : {"recording.h5", "snapshots/scene.png", "estimates/position-tumble/estimate.json"})
    EXPECT_TRUE(fs::exists(folder / "roll" / file)) << file;
  EXPECT_THAT(ended.err, HasSubstr("the results are in roll/"));
  EXPECT_THAT(ended.err, HasSubstr("tumble sweep roll --scenario roll --seeds 1..8"))
      << "a suite of the same name would sweep all its scenarios";
  // run again with a seed: the methods are the same, and no file is mixed with the existing ones
  const Ended again = in_folder({"run", "roll", "--seed", "3", "--json"});
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(methods(json_of(again)), methods(said));
  EXPECT_TRUE(fs::exists(folder / "roll_2" / "recording.h5"));
  // the folder does not hide the scenario of the same name
  const Ended drawn = in_folder({"render", "roll", "--seed", "5", "--width", "160", "--height", "120", "-o", "x.png"});
  EXPECT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_THAT(read_file(folder / "x.png"), StartsWith("\x89PNG"));
}

// a file is no scenario of the catalogue, and `sweep` accepts only those
TEST(FirstRun, AScenarioFileIsNotToBeSwept) {
  const fs::path folder = test_folder();
  const std::string file = shared_scenario("roll");
  const Ended ended = run_program({"run", file, "--seed", "1"}, [&] { fs::current_path(folder); });
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("tumble run " + file + " --seed 2"));
  EXPECT_THAT(ended.err, Not(HasSubstr("tumble sweep")));
}

TEST(Estimate, PrintsWhatMattersWithUnits) {
  const fs::path folder = test_folder() / "e";
  const Ended ended = run_successfully(
      {"estimate", (shared_run("hill") / "recording.h5").string(), "--method", "rate/tumble", "-o", folder.string()});
  EXPECT_LE(line_count(ended.out), 12u) << ended.out;
  EXPECT_THAT(ended.out, HasSubstr("time from the first to the last of the angular rates"));
  EXPECT_THAT(ended.out, HasSubstr("unit"));
  EXPECT_THAT(ended.err, HasSubstr("--json and " + (folder / "estimate.json").string() + " contain all "));
  EXPECT_GT(json::parse(read_file(folder / "estimate.json"))["health"].size(), 10u);
}

/// The method uses a parameter given by `--set`, the estimate reports it, and a wrong name or value ends the program at
/// once.
TEST(Set, AGivenParameterIsUsedReportedAndBounded) {
  const fs::path folder = test_folder();
  const fs::path recording = shared_run("roll") / "recording.h5";
  const auto estimated = [&](const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> words = {"estimate", recording.string(),      "--method", "attitude/madgwick",
                                      "-o",       (folder / name).string()};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words);
  };
  const Ended plain = estimated("plain", {});
  ASSERT_EQ(plain.status, 0) << plain.err;
  ASSERT_EQ(estimated("set", {"--set", "attitude/madgwick.gain_rad_s=0.5"}).status, 0);
  EXPECT_EQ(json::parse(read_file(folder / "plain" / "estimate.json"))["parameters"], json::object());
  EXPECT_EQ(json::parse(read_file(folder / "set" / "estimate.json"))["parameters"], (json{{"gain_rad_s", 0.5}}));
  EXPECT_NE(read_file(folder / "plain" / "attitude.tum"), read_file(folder / "set" / "attitude.tum"));
  for (const char* const wrong : {"attitude/madgwick.gain_rad_s=11", "attitude/madgwick.gain=1", "attitude/madgwick"}) {
    const Ended ended = estimated("wrong", {"--set", wrong});
    EXPECT_EQ(ended.status, 2) << wrong;
    EXPECT_THAT(ended.err, HasSubstr("attitude/madgwick")) << wrong;
  }
}

}  // namespace
}  // namespace tumble::system_test
