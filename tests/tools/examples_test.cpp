// SPDX-License-Identifier: BSD-3-Clause
#include "tools/examples/example.hpp"

#include <nlohmann/json.hpp>

#include "scenarios/methods/registry.hpp"
#include "tests/scenarios/testing.hpp"
#include "tools/examples/draw_plots.hpp"
#include "tools/report/plots.hpp"

namespace tumble::tools {
namespace {

/// Returns a recording of four samples whose gyro y axis is flat, with the estimate of raw.
scenarios::RunResult clipped_run() {
  scenarios::RunResult run;
  run.scenario = "hill";
  run.methods = scenarios::find_methods("rate/raw");
  scenarios::Estimate estimate;
  sim::Recording& recording = run.recording;
  recording.truth.period_ns = 10000000;
  recording.sensors.imus.resize(1);
  recording.truth.imus.resize(1);
  for (int k = 0; k < 4; ++k) {
    recording.truth.p_WB_m.emplace_back(k, 0, 0);
    recording.truth.q_WB.push_back(Eigen::Quaterniond::Identity());
    recording.truth.v_WB_m_s.emplace_back(1, 0, 0);
    recording.truth.w_WB_B_rad_s.emplace_back(0, 15, 0);
    recording.sensors.imus[0].time_ns.push_back(10000000 * k);
    recording.truth.imus[0].rate_rad_s.emplace_back(0, 15 + k, 0);
    AngularRateState rate;
    rate.time_ns = 10000000 * k;
    rate.w_WI_I_rad_s = {0, 10.5, 0};
    rate.clipped_axes = 2;
    estimate.rates.push_back(rate);
  }
  run.estimates = {estimate};
  return run;
}

TEST(RatePlot, ShowsTheAxisThatClips) {
  const Plot plot = rate_plot(clipped_run());
  ASSERT_EQ(plot.lines.size(), 2u);
  EXPECT_THAT(plot.lines[0].y, ElementsAre(15.0, 16.0, 17.0, 18.0));
  EXPECT_EQ(plot.lines[0].colour, kTruthColour);
  EXPECT_THAT(plot.lines[1].y, ElementsAre(10.5, 10.5, 10.5, 10.5));
  EXPECT_THAT(plot.caption, HasSubstr("y axis"));
}

TEST(RatePlot, ShowsTheGyroAlsoWhereNoMethodSaysIt) {
  scenarios::RunResult run = clipped_run();
  run.methods = scenarios::find_methods("rate/saave");
  for (int k = 0; k < 4; ++k) run.recording.sensors.imus[0].gyro_rad_s.emplace_back(0, 10.25, 0);
  const Plot plot = rate_plot(run);
  ASSERT_EQ(plot.lines.size(), 3u);
  EXPECT_THAT(plot.lines[2].y, ElementsAre(10.25, 10.25, 10.25, 10.25));
  EXPECT_EQ(plot.lines[2].name, "gyro reading");
  EXPECT_EQ(plot.lines[2].colour, 1);
}

TEST(DrawnOf, HasAColourForEachAndBeginsWithTheFirst) {
  EXPECT_THAT(drawn_of({}), ElementsAre());
  EXPECT_THAT(drawn_of({false, true, false}), ElementsAre(0, 1, 2));
  EXPECT_THAT(drawn_of({false, false, true, true, true, true, true}), ElementsAre(0, 2, 3, 4, 5, 6));
  EXPECT_THAT(drawn_of(std::vector<bool>(9, true)), ElementsAre(0, 1, 2, 3, 4, 5));
}

TEST(RatePlot, IsEmptyWhenNothingClips) {
  scenarios::RunResult run = clipped_run();
  for (AngularRateState& rate : run.estimates[0].rates) rate.clipped_axes = 0;
  EXPECT_TRUE(rate_plot(run).lines.empty());
}

TEST(PathPlot, HasEqualScales) {
  const Plot plot = path_plot(clipped_run(), {});
  ASSERT_EQ(plot.lines.size(), 1u);
  EXPECT_THAT(plot.lines[0].x, ElementsAre(0.0, 1.0, 2.0, 3.0));
  const Figure figure = figure_of(plot, "path-hill");
  EXPECT_EQ(nlohmann::json::parse(figure.traces)[0]["x"], nlohmann::json({0.0, 1.0, 2.0, 3.0}));
  EXPECT_EQ(nlohmann::json::parse(figure.layout)["yaxis"]["scaleanchor"], "x");
}

TEST(Figure, OfAPlotKeepsGapsSpansAndWhatIsHidden) {
  Plot plot;
  plot.shaded = {{1.0, 2.0}};
  PlotLine line;
  line.x = {0.0, 1.0};
  line.y = {std::nan(""), 4.0};
  line.hidden = line.dotted = true;
  plot.lines = {line};
  const Figure figure = figure_of(plot, "id");
  EXPECT_TRUE(nlohmann::json::parse(figure.traces)[0]["y"][0].is_null());
  EXPECT_EQ(nlohmann::json::parse(figure.traces)[0]["visible"], "legendonly");
  EXPECT_EQ(nlohmann::json::parse(figure.traces)[0]["line"]["dash"], "dot");
  ASSERT_EQ(nlohmann::json::parse(figure.layout)["shapes"].size(), 1u);
  EXPECT_EQ(nlohmann::json::parse(figure.layout)["shapes"][0]["x1"], 2.0);
}

bool nothing_stands_in(const fs::path& folder) {
  const FoundExamples found = read_examples(folder, Pictures::read);
  return found.examples.empty() && found.unreadable.empty();
}

/// Returns whether no example is found, with the reason and the path.
bool all_is_unreadable_in(const fs::path& folder) {
  const FoundExamples found = read_examples(folder, Pictures::read);
  return found.examples.empty() && found.unreadable.size() == 1 &&
         found.unreadable[0].find((folder / "examples.json").string()) == 0;
}

class ExamplesTest : public test::TemporaryFolder {
 protected:
  /// Returns an example with every field of a list, each with a different value.
  static Example sample(std::uint64_t seed) {
    Example example;
    example.scenario = "hill";
    example.seed = seed;
    example.motion = "tumble";
    example.choice = "why";
    example.of_failure = seed % 2 == 1;
    example.recording_digest = "abc";
    example.digest_without_lidars = "def";
    example.made_of = "123";
    example.pictures = {{"scene", "alternative", "caption", {{"truth", kTruthColour}, {"slam/icp", 0}}, {1, 2, 3}}};
    Plot plot = path_plot(clipped_run(), {});
    plot.shaded = {{0.5, 1.5}};
    plot.wide = false;
    plot.lines[0].y[1] = std::nan("");
    plot.lines[0].x[2] = 0.1;
    example.plots = {plot};
    example.replay = replay_file(example);
    example.replay_page = "<!DOCTYPE html>";
    return example;
  }
  void leave(const std::vector<Example>& examples) {
    std::vector<std::string> texts;
    for (const Example& example : examples) {
      write_pictures(folder_, example);
      texts.push_back(to_json(example));
    }
    write_examples(folder_, texts);
  }
  void overwrite_list(const std::string& text) { std::ofstream(folder_ / "examples.json") << text; }
};

TEST_F(ExamplesTest, ComeBackAsTheyWereLeft) {
  leave({sample(3), sample(18446744073709551615u)});
  const auto [read, unreadable] = read_examples(folder_, Pictures::read);
  EXPECT_TRUE(unreadable.empty());
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[1].seed, 18446744073709551615u);
  EXPECT_EQ(to_json(read[0]), to_json(sample(3))) << "every field, to the bit";
  EXPECT_EQ(read[0].pictures[0].png, sample(3).pictures[0].png);
  EXPECT_TRUE(std::isnan(read[0].plots[0].lines[0].y[1]));
  EXPECT_EQ(read[0].plots[0].lines[0].x[2], 0.1);
  EXPECT_TRUE(read_examples(folder_, Pictures::left_out).examples[0].pictures[0].png.empty());
  EXPECT_EQ(read[0].replay, "hill-3-replay.html");
  EXPECT_EQ(fs::file_size(folder_ / read[0].replay), sample(3).replay_page.size());
  EXPECT_TRUE(nothing_stands_in(folder_ / "nowhere"));
}

TEST_F(ExamplesTest, AReplayThatIsGoneOrElsewhereIsRefusedAndNoneIsNone) {
  Example without = sample(3);
  without.replay.clear();
  leave({without});
  EXPECT_EQ(read_examples(folder_, Pictures::read).examples.at(0).replay, "") << "as earlier versions have left it";
  leave({sample(3)});
  fs::remove(folder_ / "hill-3-replay.html");
  EXPECT_TRUE(all_is_unreadable_in(folder_));
  for (const char* name : {"../hill-3-replay.html", ".hidden.html", "examples.json"}) {
    Example elsewhere = sample(3);
    elsewhere.replay = name;
    overwrite_list("{\"format\": \"tumble examples\", \"version\": 1, \"examples\": [" + to_json(elsewhere) + "]}");
    EXPECT_TRUE(all_is_unreadable_in(folder_)) << name;
  }
}

TEST_F(ExamplesTest, WhatANewListHasNotIsRemovedAndNothingElse) {
  leave({sample(3), sample(4)});
  std::ofstream(folder_ / "mine.png") << "mine";
  leave({sample(4)});
  EXPECT_FALSE(fs::exists(folder_ / "hill-3-scene.png"));
  EXPECT_FALSE(fs::exists(folder_ / "hill-3-replay.html"));
  EXPECT_TRUE(fs::exists(folder_ / "hill-4-scene.png"));
  EXPECT_TRUE(fs::exists(folder_ / "hill-4-replay.html"));
  EXPECT_TRUE(fs::exists(folder_ / "mine.png"));
}

TEST_F(ExamplesTest, AListThatIsDamagedIsRefused) {
  leave({sample(3)});
  fs::remove(folder_ / "hill-3-scene.png");
  EXPECT_TRUE(all_is_unreadable_in(folder_)) << "a picture is gone";
  for (const char* text : {"", "{", "[]", "{\"format\": \"other\", \"version\": 1, \"examples\": []}",
                           "{\"format\": \"tumble examples\", \"version\": 1, \"examples\": [{}]}"}) {
    overwrite_list(text);
    EXPECT_TRUE(all_is_unreadable_in(folder_)) << text;
  }
}

TEST_F(ExamplesTest, WhatIsDamagedCostsTheOthersNothing) {
  leave({sample(3), sample(4), sample(5)});
  const fs::path list = folder_ / "examples.json";
  const std::string whole = test::read_file(list);
  const auto seeds = [&] {
    std::vector<std::uint64_t> out;
    for (const Example& example : read_examples(folder_, Pictures::read).examples) out.push_back(example.seed);
    return out;
  };
  // the picture of this example is missing
  fs::remove(folder_ / "hill-4-scene.png");
  EXPECT_THAT(seeds(), ElementsAre(3u, 5u));
  ASSERT_EQ(read_examples(folder_, Pictures::read).unreadable.size(), 1u);
  EXPECT_THAT(read_examples(folder_, Pictures::read).unreadable[0],
              AllOf(HasSubstr("example 2"), HasSubstr("hill-4-scene.png")));
  // this example lacks a field
  std::string text = whole;
  text.replace(text.find("\"motion\""), 8, "\"notion\"");
  overwrite_list(text);
  EXPECT_THAT(seeds(), ElementsAre(5u)) << "the first has no motion, the second no picture";
  // the list is truncated in its last example
  overwrite_list(whole.substr(0, whole.size() - 200));
  EXPECT_THAT(seeds(), ElementsAre(3u));
  EXPECT_EQ(read_examples(folder_, Pictures::read).unreadable.size(), 2u) << "the cut, and the picture";
  EXPECT_EQ(set_damaged_aside(folder_), folder_ / "examples.json.damaged");
  EXPECT_EQ(fs::file_size(folder_ / "examples.json.damaged"), whole.size() - 200);
}

TEST_F(ExamplesTest, AFolderInAFilesPlaceIsRefused) {
  leave({sample(3)});
  const fs::path picture = folder_ / "hill-3-scene.png", list = folder_ / "examples.json";
  fs::remove(picture);
  fs::create_directories(picture);
  EXPECT_TRUE(all_is_unreadable_in(folder_));
  fs::remove(list);
  EXPECT_TRUE(nothing_stands_in(folder_)) << "an absent list is none";
  fs::create_directories(list);
  EXPECT_TRUE(all_is_unreadable_in(folder_)) << "one that cannot be read is not absent";
}

TEST_F(ExamplesTest, AListNamesFilesOfItsOwnFolderAlone) {
  const fs::path secret = folder_ / "secret.png", own = folder_ / "own";
  std::ofstream(secret) << "secret";
  fs::create_directories(own);
  std::string list = "{\"format\": \"tumble examples\", \"version\": 1, \"examples\": [" + to_json(sample(3)) + "]}";
  const std::string name = "hill-3-scene.png";
  list.replace(list.find(name), name.size(), "../secret.png");
  std::ofstream(own / "examples.json") << list;
  EXPECT_TRUE(all_is_unreadable_in(own));
  write_examples(own, {});
  EXPECT_TRUE(fs::exists(secret)) << "nor is one removed";
}

}  // namespace
}  // namespace tumble::tools
