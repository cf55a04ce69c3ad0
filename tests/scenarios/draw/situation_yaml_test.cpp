// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "scenarios/draw/fixture_registry.hpp"
#include "scenarios/draw/scenario.hpp"

namespace tumble::scenarios {
namespace {

using testing::HasSubstr;

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
  EXPECT_THAT(fixture::complaint([&] { to_yaml(situation); }), HasSubstr("world.slope_rad"));
  const auto complaint_of = [](const std::string& changed) {
    return fixture::complaint([&] { situation_from_yaml(changed, "r.h5"); });
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
