// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/scenario_text.hpp"

#include <bit>

#include "scenarios/draw/fixture_registry.hpp"
#include "scenarios/draw/scenario.hpp"
#include "tests/testing.hpp"

namespace tumble::scenarios {
namespace {

using fixture::kScenario;
using fixture::with;
using fixture::Wrong;
using Shape = Distribution::Shape;

std::string complaint_of(const std::string& text) {
  return test::complaint([&] { parse_scenario(text, "hill.yaml", fixture::registry()); });
}

TEST(ScenarioText, ReadsEveryPart) {
  const Scenario scenario = parse_scenario(kScenario, "hill.yaml", fixture::registry());
  EXPECT_EQ(scenario.name, "hill");
  EXPECT_EQ(scenario.doc, "a rig is pushed down a hill");
  EXPECT_EQ(scenario.file, "hill.yaml");
  EXPECT_EQ(scenario.duration_s, (Distribution{Shape::constant, {11.0}, 3}));
  EXPECT_EQ(scenario.world.type, "hill");
  EXPECT_EQ(scenario.world.numbers.at("slope_rad"), (Distribution{Shape::uniform, {0.5, 0.7}, 4}));
  EXPECT_EQ(scenario.robot.numbers.at("mass_kg"), (Distribution{Shape::normal, {8, 0.5, 6, 10}, 5}));
  EXPECT_EQ(scenario.motion.numbers.at("force_n"), (Distribution{Shape::constant, {450.5}, 8}));
  ASSERT_EQ(scenario.sensors.size(), 2u);
  EXPECT_EQ(scenario.sensors[0].device, "mti30");
  EXPECT_EQ(scenario.sensors[0].numbers.at("output_rate_hz"), (Distribution{Shape::constant, {100.0}, 10}));
  EXPECT_EQ(scenario.sensors[0].mount_error.at("x_m"), (Distribution{Shape::normal, {0.0, 0.003}, 10}));
  EXPECT_EQ(scenario.sensors[1].site, "vn100");
  EXPECT_EQ(scenario.sensors[1].line, 11);
}

class WrongScenario : public testing::TestWithParam<Wrong> {};

TEST_P(WrongScenario, IsRefusedWithFileLineAndReason) {
  const Wrong& wrong = GetParam();
  const std::string message = complaint_of(with(kScenario, wrong.from, wrong.to));
  EXPECT_THAT(message, StartsWith(wrong.where));
  EXPECT_THAT(message, HasSubstr(wrong.what));
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    , WrongScenario,
    testing::Values(
        Wrong{"slope_rad", "slop_rad", "hill.yaml:4: world.slop_rad: ", "did you mean 'slope_rad'?"},
        Wrong{"type: hill", "type: hil", "hill.yaml:4: world.type: ", "did you mean 'hill'?"},
        Wrong{"type: hill, ", "", "hill.yaml:4: world: ", "key 'type' is missing"},
        Wrong{"motion:", "motoin:", "hill.yaml:6: motoin: ", "did you mean 'motion'?"},
        Wrong{"doc: a rig is pushed down a hill\n", "", "hill.yaml:1: ", "key 'doc' is missing"},
        Wrong{"doc: a rig", "name: twice\ndoc: a rig", "hill.yaml:2: ", "key 'name' is given twice"},
        Wrong{"force_n: 450.5", "force_n: 450.5\n  force_n: 2", "hill.yaml:9: motion: ", "given twice"},
        Wrong{"450.5", "450,5", "hill.yaml:8: motion.force_n: ", "must be a number; it is '450,5'"},
        Wrong{"450.5", "450.5 N", "hill.yaml:8: motion.force_n: ", "must be a number"},
        Wrong{"450.5", "\"450.5\"", "hill.yaml:8: motion.force_n: ", "is the text"},
        Wrong{"450.5", ".nan", "hill.yaml:8: motion.force_n: ", "must be a number"},
        Wrong{"450.5", "nan", "hill.yaml:8: motion.force_n: ", "must be finite"},
        Wrong{"450.5", ".inf", "hill.yaml:8: motion.force_n: ", "must be a number"},
        Wrong{"450.5", "1e999", "hill.yaml:8: motion.force_n: ", "outside the range of a double"},
        Wrong{"450.5", "", "hill.yaml:8: motion.force_n: ", "must be a number or one of"},
        Wrong{"450.5", "6000", "hill.yaml:8: motion.force_n: ", "is 6000 N; it must be within [0, 5000]"},
        Wrong{"[0.5, 0.7]", "[0.7, 0.5]", "hill.yaml:4: world.slope_rad: ", "low 0.7 is above high 0.5"},
        Wrong{"[0.5, 0.7]", "[0.5, 1.3]",
              "hill.yaml:4: world.slope_rad: ", "can reach 1.3 rad; it must be within [0, 1.2]"},
        Wrong{"[0.5, 0.7]", "[0.5]", "hill.yaml:4: world.slope_rad: ", "uniform needs [low, high]"},
        Wrong{"[0.5, 0.7]", "[0.5, nan]", "hill.yaml:4: world.slope_rad.uniform[1]: ", "must be finite"},
        Wrong{"[0.5, 0.7]", "0.5", "hill.yaml:4: world.slope_rad.uniform: ", "must be a list"},
        Wrong{"uniform", "unifrom", "hill.yaml:4: world.slope_rad.unifrom: ", "did you mean 'uniform'?"},
        Wrong{"{uniform: [0.5, 0.7]}", "{uniform: [0.5, 0.7], choice: [1]}",
              "hill.yaml:4: world.slope_rad: ", "exactly one"},
        Wrong{"{uniform: [0.5, 0.7]}", "{choice: []}",
              "hill.yaml:4: world.slope_rad: ", "'choice' must list at least one value"},
        Wrong{"{uniform: [0.5, 0.7]}", "{log_uniform: [0, 0.7]}", "hill.yaml:4: world.slope_rad: ", "greater than 0"},
        Wrong{"{uniform: [0.5, 0.7]}", "[0.5, 0.7]", "hill.yaml:4: world.slope_rad: ", "must be a number or one of"},
        Wrong{"[8, 0.5, 6, 10]", "[8, -0.5]", "hill.yaml:5: robot.mass_kg: ", "sigma -0.5 is below 0"},
        Wrong{"[8, 0.5, 6, 10]", "[8, 0.5, 10, 6]", "hill.yaml:5: robot.mass_kg: ", "low 10 is above high 6"},
        Wrong{"[8, 0.5, 6, 10]", "[8, 0.5, 10, 12]", "hill.yaml:5: robot.mass_kg: ", "contains less than 1 %"},
        Wrong{"[8, 0.5, 6, 10]", "[8, 0, 9, 10]", "hill.yaml:5: robot.mass_kg: ", "contains less than 1 %"},
        Wrong{"[8, 0.5, 6, 10]", "[8, 0.5, 6]", "hill.yaml:5: robot.mass_kg: ", "'normal' needs"},
        Wrong{"[8, 0.5, 6, 10]", "[25, 0.5]", "hill.yaml:5: robot.mass_kg: ", "can reach 25 kg"},
        Wrong{"site: vn100", "sight: vn100", "hill.yaml:11: sensors[1]: ", "key 'site' is missing"},
        Wrong{"name: imu_reference", "name: imu", "hill.yaml:11: sensors[1]: ", "exists already in line 10"},
        Wrong{"name: imu_reference", "name: IMU 2", "hill.yaml:11: sensors[1].name: ", "lower-case"},
        Wrong{"kind: imu, device: mti30, site: vn100", "kind: imo, device: mti30, site: vn100",
              "hill.yaml:11: sensors[1].kind: ", "did you mean 'imu'?"},
        Wrong{"output_rate_hz", "output_rate",
              "hill.yaml:10: sensors[0].output_rate: ", "did you mean 'output_rate_hz'?"},
        Wrong{"x_m:", "q_m:", "hill.yaml:10: sensors[0].mount_error.q_m: ", "did you mean 'x_m'?"},
        Wrong{"duration_s: 11", "duration_s: 0", "hill.yaml:3: duration_s: ", "must be within"},
        Wrong{"duration_s: 11", "duration_s: [11", "hill.yaml:", "not valid YAML"},
        Wrong{"world: {type: hill, slope_rad: {uniform: [0.5, 0.7]}}", "world: hill",
              "hill.yaml:4: world: ", "must be a map"}));

TEST(ScenarioText, RefusesWhatIsNotOneMap) {
  EXPECT_EQ(complaint_of(""), "hill.yaml: the file is empty");
  EXPECT_EQ(complaint_of("# only a comment\n"), "hill.yaml: the file is empty");
  EXPECT_THAT(complaint_of("- 1\n- 2\n"), HasSubstr("must be a map"));
  const std::string long_name = "name: " + std::string(5000, 'a');
  EXPECT_THAT(complaint_of(with(kScenario, "name: hill", long_name.c_str())),
              AllOf(StartsWith("hill.yaml:1: name: "), HasSubstr("has 5000 characters; it must have at most 100")));
  EXPECT_THAT(complaint_of(kScenario + "---\nname: b\n"), HasSubstr("more than one document"));
  EXPECT_THAT(complaint_of("? [a, b]\n: 1\n"), HasSubstr("must be text; it is a list"));
  EXPECT_THAT(complaint_of(with(kScenario, "sensors:", "sensors: []\nx:")), HasSubstr("unknown key 'x'"));
  EXPECT_NE(complaint_of(std::string(100000, '[')), "");
}

TEST(ScenarioText, AcceptsEveryDistributionWithinItsBounds) {
  for (const char* good :
       {"{uniform: [0, 1.2]}", "{uniform: [0.5, 0.5]}", "{normal: [0.5, 0]}", "{normal: [-0.1, 0.1, 0, 1]}",
        "{log_uniform: [1e-3, 1.0]}", "{choice: [0.1]}", "1e-1", "-0"}) {
    EXPECT_EQ(complaint_of(with(kScenario, "{uniform: [0.5, 0.7]}", good)), "") << good;
  }
}

// A truncated or garbled file must end in a scenario or in BadInput, without a crash or another exception.
TEST(ScenarioText, SurvivesTruncationAndFlippedBytes) {
  int refused = 0;
  const auto feed = [&](const std::string& text) {
    try {
      parse_scenario(text, "hill.yaml", fixture::registry());
    } catch (const BadInput&) {
      ++refused;
    }
  };
  for (std::size_t length = 0; length < kScenario.size(); ++length) feed(kScenario.substr(0, length));
  EXPECT_GT(refused, static_cast<int>(kScenario.size()) / 2);
  for (std::size_t i = 0; i < kScenario.size(); ++i) {
    for (const char byte : {'\0', '\xff', ':', '[', '}', '"', '\n', '*', '&'}) {
      std::string text = kScenario;
      text[i] = byte;
      feed(text);
    }
  }
}

sim::Situation example() {
  sim::Situation s;
  s.scenario = "hill";
  s.seed = std::numeric_limits<std::uint64_t>::max();
  s.duration_s = 0.1 + 0.2;
  s.world.type = "hill";
  s.world.values.set("third", 1.0 / 3.0);
  s.world.values.set("tiny", std::numeric_limits<double>::denorm_min());
  s.world.values.set("huge", -std::numeric_limits<double>::max());
  s.world.values.set("unbounded", std::numeric_limits<double>::infinity());
  s.robot.type = "rig";
  s.motion.type = "push";
  s.motion.values.set("force_n", 450.0);
  sim::SensorSpec sensor{"imu", "imu", "mti30", "mti30", {}, {}};
  sensor.values.set("output_rate_hz", 1e22);
  sensor.mount_error.set("x_m", -0.0);
  s.sensors = {sensor, {"lidar", "spinning_lidar", "", "a \"site\": {odd}, # \\ \n", {}, {}}};
  return s;
}

TEST(SituationYaml, RoundTripIsExact) {
  const sim::Situation situation = example();
  const sim::Situation back = situation_from_yaml(to_yaml(situation), "recording.h5");
  EXPECT_EQ(back, situation);
  EXPECT_TRUE(std::signbit(back.sensors[0].mount_error.at("x_m"))) << "-0.0 keeps its sign";
  EXPECT_EQ(to_yaml(back), to_yaml(situation));
}

TEST(SituationYaml, KeepsTheSeedsOfRandomStreams) {
  sim::Situation situation = example();
  EXPECT_EQ(to_yaml(situation).find("streams"), std::string::npos);
  situation.streams = {{"imu", std::numeric_limits<std::uint64_t>::max()}, {sim::kWorldStream, 0}};
  EXPECT_EQ(situation_from_yaml(to_yaml(situation), "recording.h5"), situation);
}

TEST(SituationYaml, RoundTripIsExactForManyDoubles) {
  sim::Situation situation = example();
  std::uint64_t bits = 1;
  for (int i = 0; i < 2000; ++i) {
    bits = bits * 6364136223846793005u + 1442695040888963407u;
    const auto value = std::bit_cast<double>(bits);
    if (!std::isnan(value)) situation.world.values.set(std::to_string(i), value);
  }
  EXPECT_EQ(situation_from_yaml(to_yaml(situation), "a"), situation);
}

TEST(SituationYaml, RefusesNanAndWhatIsNotASituation) {
  sim::Situation situation = example();
  const std::string text = to_yaml(situation);
  situation.world.values.set("slope_rad", std::nan(""));
  EXPECT_THAT(test::complaint([&] { to_yaml(situation); }), HasSubstr("world.slope_rad"));
  const auto complaint_of = [](const std::string& changed) {
    return test::complaint([&] { situation_from_yaml(changed, "r.h5"); });
  };
  EXPECT_EQ(complaint_of(text), "");
  EXPECT_THAT(complaint_of(fixture::with(text, "seed: ", "sed: ")),
              HasSubstr("r.h5:2: sed: unknown key 'sed'; did you mean 'seed'?"));
  EXPECT_THAT(complaint_of(fixture::with(text, "seed: 1", "seed: -1")), HasSubstr("must be an integer"));
  EXPECT_THAT(complaint_of(fixture::with(text, "force_n: 450", "force_n: nan")), HasSubstr("must be finite"));
  EXPECT_THAT(complaint_of(text.substr(0, text.size() / 2)), HasSubstr("r.h5:"));
}

}  // namespace
}  // namespace tumble::scenarios
