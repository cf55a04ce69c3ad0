// SPDX-License-Identifier: BSD-3-Clause
// The test scores a foreign TUM file that shares little or nothing with the recording.
#include "scenarios/recordings/number_text.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "system/program.hpp"

namespace tumble::system_test {
namespace {

class GivenTrajectory : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = test_folder();
    recording_ = (shared_run("roll") / "recording.h5").string();
    const std::string tum = (folder_ / "truth.tum").string();
    run_successfully({"export", recording_, "--format", "tum", "-o", tum, "--quiet"});
    std::ifstream file(tum);
    for (std::string line; std::getline(file, line);) {
      if (!line.starts_with('#')) lines_.push_back(line);
    }
    ASSERT_GT(lines_.size(), 1000u);
  }

  /// Scores the first `count` true poses, with their stamps times `factor`.
  Ended score(std::size_t count, double factor, bool as_json = false) const {
    const fs::path tum = folder_ / "theirs.tum";
    {
      std::ofstream file(tum);
      for (std::size_t k = 0; k < count; ++k) {
        std::istringstream words(lines_[k]);
        std::string stamp, rest;
        words >> stamp;
        std::getline(words, rest);
        const std::int64_t time_ns = scenarios::parse_time_ns(stamp, 9).value() - scenarios::kExportOrigin_ns;
        stamp.clear();
        scenarios::append_seconds(stamp, std::lround(static_cast<double>(time_ns) * factor));
        file << stamp << rest << '\n';
      }
    }
    std::vector<std::string> arguments = {"score", tum.string(), recording_, "--frame", "body"};
    if (as_json) arguments.emplace_back("--json");
    return run_program(arguments);
  }

  fs::path folder_;
  std::string recording_;
  std::vector<std::string> lines_;
};

TEST_F(GivenTrajectory, WhatWasNotComparedIsNotPerfect) {
  const auto refused = [](const Ended& ended) {
    EXPECT_EQ(ended.status, 2) << ended.out;
    EXPECT_EQ(ended.out, "");
    EXPECT_EQ(line_count(ended.err), 1u) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("ime unit"));
    return ended.err;
  };
  EXPECT_THAT(refused(score(1, 1.0)), HasSubstr("1 of 1 poses"));
  // the file has only the first two poses, 0.5 ms apart, of some seconds
  EXPECT_THAT(refused(score(2, 1.0)), HasSubstr("cover 0.0 %"));
  // the stamps are in microseconds: the second pose lies beyond the end
  EXPECT_THAT(refused(score(lines_.size(), 1e6)), HasSubstr(" 1 of " + std::to_string(lines_.size()) + " poses"));
  // the stamps are in milliseconds, with a pose every 0.5 ms: some thirty lie within the recording, each at a wrong
  // time
  EXPECT_THAT(refused(score(lines_.size(), 1e3)),
              HasSubstr("1000 times the duration of the recording. The time unit of the file may be ms;"));
  // the stamps are in kiloseconds: all lie in the first thousandth of the recording
  EXPECT_THAT(refused(score(lines_.size(), 1e-3)), HasSubstr("a score needs at least 2 poses that cover 1 %"));
}

TEST_F(GivenTrajectory, HowMuchWasComparedStandsInTheTable) {
  const std::size_t half = lines_.size() / 2;
  const Ended table = score(half, 1.0);
  EXPECT_EQ(table.status, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("covered_share"));
  EXPECT_THAT(table.out, HasSubstr(std::to_string(half) + " of " + std::to_string(half)));
  const nlohmann::json document = json_of(score(half, 1.0, true));
  EXPECT_NEAR(document["covered"]["share"].get<double>(), 0.5, 0.05);
  EXPECT_EQ(document["covered"]["compared"], half);
  EXPECT_EQ(document["covered"]["poses"], half);
  // an estimate in a folder states what it is, and has no such rows
  const Ended own =
      run_successfully({"score", (shared_run("roll") / "estimates" / "position-rolling").string(), recording_});
  EXPECT_THAT(own.out, Not(HasSubstr("covered_share")));
}

// the recording is a tumble: a sphere that rolls straight on turns about one axis, which may be the same in another
// order
TEST_F(GivenTrajectory, AFolderThatNamesNoRecordingIsACaution) {
  const fs::path given = folder_ / "estimate";
  fs::copy(shared_run("roll") / "estimates" / "position-rolling", given);
  const Ended named = run_program({"score", given.string(), recording_});
  EXPECT_THAT(named.err, Not(HasSubstr("does not name its recording")));
  nlohmann::json header = nlohmann::json::parse(read_file(given / "estimate.json"));
  header.erase("sensors_digest");
  std::ofstream(given / "estimate.json") << header;
  const Ended ended = run_successfully({"score", given.string(), recording_});
  EXPECT_THAT(ended.err, HasSubstr("caution: " + given.string() + " does not name its recording"));
}

TEST_F(GivenTrajectory, QuaternionsInAnotherOrderAreSaid) {
  const std::string recording = (shared_run("hill") / "recording.h5").string();
  const fs::path truth = folder_ / "hill.tum", tum = folder_ / "theirs.tum";
  run_successfully({"export", recording, "--format", "tum", "-o", truth.string(), "--quiet"});
  const auto said = [&](bool w_first) {
    {
      std::ifstream as_it_is(truth);
      std::ofstream file(tum);
      for (std::string line; std::getline(as_it_is, line);) {
        if (line.starts_with('#')) continue;
        std::istringstream words(line);
        std::array<std::string, 8> word;
        for (std::string& each : word) words >> each;
        if (w_first) std::rotate(word.begin() + 4, word.begin() + 7, word.end());
        for (const std::string& each : word) file << each << ' ';
        file << '\n';
      }
    }
    const Ended ended = run_successfully({"score", tum.string(), recording, "--frame", "body"});
    return ended.err;
  };
  EXPECT_THAT(said(true), HasSubstr("if the quaternions were stored with w first (expected order: x y z w)"));
  EXPECT_THAT(said(false), Not(HasSubstr("caution")));
}

TEST_F(GivenTrajectory, AFileOfAnEstimateIsNotWrittenOver) {
  const fs::path estimate = folder_ / "e";
  fs::copy(shared_run("roll") / "estimates" / "position-rolling", estimate);
  const std::string target = (estimate / "estimate.json").string(), whole = read_file(target);
  ASSERT_NE(whole, "");
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"replay", recording_, estimate.string(), "-o", target},
        {"render", recording_, estimate.string(), "-o", target},
        {"export", recording_, "--format", "mcap", "--estimate", estimate.string(), "-o", target}}) {
    const Ended ended = run_program(arguments);
    EXPECT_EQ(ended.status, 2) << arguments.front();
    EXPECT_THAT(ended.err, HasSubstr("choose another output name")) << arguments.front();
    EXPECT_EQ(read_file(target), whole) << arguments.front();
  }
}

}  // namespace
}  // namespace tumble::system_test
