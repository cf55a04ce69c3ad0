// SPDX-License-Identifier: BSD-3-Clause
#include "tools/replay/page.hpp"

#include <nlohmann/json.hpp>

#include "tests/testing.hpp"
#include "tests/tools/replays.hpp"

namespace tumble::tools {
namespace {

using nlohmann::json;
using scenarios::Estimate;
using scenarios::Frame;
using testing::known_estimate;
using testing::known_pose;
using testing::known_recording;

/// Returns an array of the packed bytes as numbers.
template <typename Number>
std::vector<Number> unpacked(const PackedReplay& data, const std::string& name) {
  const json at = json::parse(data.head).at("arrays").at(name);
  std::vector<Number> numbers(at.at("length").get<std::size_t>());
  const std::size_t offset = at.at("offset");
  EXPECT_EQ(offset % 4, 0u) << name;
  EXPECT_LE(offset + sizeof(Number) * numbers.size(), data.bytes.size()) << name;
  if (!numbers.empty()) std::memcpy(numbers.data(), data.bytes.data() + offset, sizeof(Number) * numbers.size());
  return numbers;
}

Replay known_replay(const std::string& name, const sim::Recording& recording, bool with_truth = true) {
  static const Estimate estimate = known_estimate(Frame::body, Isometry3d::Identity(), testing::other_world());
  static const sim::Surface surface(testing::room());
  ReplayInput input;
  input.title = name;
  input.facts = {{name, name}};
  input.sensors = &recording.sensors;
  input.truth = with_truth ? &recording.truth : nullptr;
  input.built = &testing::room();
  input.surface = with_truth ? &surface : nullptr;
  input.estimates = {{name, &estimate}};
  return replay_of(input);
}

TEST(PackedReplay, AKnownPoseAtAKnownTimeComesBackWithinItsQuantum) {
  const PackedReplay data = packed(known_replay("x", known_recording()));
  const json head = json::parse(data.head);
  const double step_s = head.at("pose_step_s");
  for (const std::string actor : {"actor0", "actor1"}) {
    const auto positions = unpacked<float>(data, actor + ".positions");
    const auto attitudes = unpacked<std::int16_t>(data, actor + ".attitudes");
    ASSERT_EQ(positions.size() / 3, attitudes.size() / 4);
    for (const std::size_t k : {std::size_t{0}, std::size_t{17}, positions.size() / 3 - 1}) {
      const Isometry3d truth = known_pose(std::llround(1e9 * step_s * static_cast<double>(k)));
      for (int axis = 0; axis < 3; ++axis) {
        const double origin = head.at("origin_W_m").at(static_cast<std::size_t>(axis));
        EXPECT_NEAR(positions[3 * k + static_cast<std::size_t>(axis)] + origin, truth.translation()[axis], 1e-6);
      }
      Quaterniond q;
      for (int i = 0; i < 4; ++i) q.coeffs()[i] = attitudes[4 * k + static_cast<std::size_t>(i)] / 32767.0;
      // an error of half a step in each of four numbers rotates by at most two steps
      EXPECT_LT(q.normalized().angularDistance(Quaterniond(truth.linear())), 2.0 / 32767.0);
    }
  }
}

TEST(PackedReplay, PointsTimesErrorsAndRatesComeBackWithinTheirQuanta) {
  const Replay replay = known_replay("x", known_recording());
  const PackedReplay data = packed(replay);
  const json head = json::parse(data.head);
  const double scale = head.at("points").at("scale_m"), rate_scale = head.at("strip").at("scale_rad_s");
  const auto positions = unpacked<std::int16_t>(data, "points.positions");
  const auto times = unpacked<std::uint32_t>(data, "points.times");
  const auto errors = unpacked<std::uint8_t>(data, "actor1.errors");
  ASSERT_EQ(times.size(), replay.points.time_ns.size());
  ASSERT_GT(times.size(), 600u);
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_NEAR(scale * positions[3 * i + 2], replay.points.p_B_m[i].z(), 0.5001 * scale);
    EXPECT_NEAR(1e3 * times[i], static_cast<double>(replay.points.time_ns[i]), 500.0);
    EXPECT_NEAR(errors[i] / 254.0, replay.actors[1].error_m[i], 0.51 / 254.0);
  }
  EXPECT_LT(scale, 1e-4) << "the farthest is 1.24 m away";
  const auto gyro = unpacked<std::int16_t>(data, "strip.gyro");
  EXPECT_NEAR(rate_scale * gyro[3 * 50 + 2], 1.5, rate_scale);
  const auto rates = unpacked<std::int16_t>(data, "actor1.rates");
  EXPECT_EQ(rates[2], -32768) << "not known";
  EXPECT_NEAR(rate_scale * rates[3 * 50 + 2], 3.0, rate_scale);
  EXPECT_EQ(unpacked<std::uint8_t>(data, "strip.clipped")[50], 4);
}

TEST(PackedReplay, WhatIsNotKnownIsMarked) {
  Replay replay = known_replay("x", known_recording());
  replay.actors[1].error_m[3] = std::nanf("");
  replay.actors[1].track.p_WB_m[5].setConstant(std::nan(""));
  const PackedReplay data = packed(replay);
  EXPECT_EQ(unpacked<std::uint8_t>(data, "actor1.errors")[3], 255);
  EXPECT_NE(unpacked<std::uint8_t>(data, "actor1.errors")[4], 255);
  EXPECT_TRUE(std::isnan(unpacked<float>(data, "actor1.positions")[15]));
}

TEST(PackedReplay, TheWorldsCornersAndCellsAddUp) {
  const PackedReplay data = packed(known_replay("x", known_recording()));
  const json world = json::parse(data.head).at("world");
  std::size_t vertices = 0, corners = 0;
  for (const json& part : world.at("parts")) {
    if (part.contains("rows")) {
      EXPECT_EQ(part.at("rows").get<std::size_t>() * part.at("columns").get<std::size_t>(), part.at("vertices"));
    }
    vertices += part.at("vertices").get<std::size_t>();
    corners += part.at("corners").get<std::size_t>();
  }
  EXPECT_GT(vertices, 0u);
  EXPECT_EQ(unpacked<std::int16_t>(data, "world.vertices").size(), 3 * vertices);
  EXPECT_EQ(unpacked<std::uint16_t>(data, "world.corners").size(), corners);
}

TEST(ReplayPage, EveryNameIsDataAndNoMarkup) {
  const std::string evil = "</script><script>alert(1)</script><img src=x onerror=alert(1)>{{script}}";
  const std::string page = replay_page(known_replay(evil, known_recording()));
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  std::size_t scripts = 0;
  for (std::size_t at = page.find("</script"); at != std::string::npos; at = page.find("</script", at + 1)) ++scripts;
  EXPECT_EQ(scripts, 3u) << "head, bytes and the page's own";
  // the page's head contains the same name
  const std::string open = "<script type=\"application/json\" id=\"head\">";
  const std::size_t begin = page.find(open) + open.size();
  const json head = json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  EXPECT_EQ(head.at("title"), evil);
  EXPECT_EQ(head.at("actors").at(1).at("name"), evil);
  // negative control: the search would find the text
  EXPECT_THAT(page + evil, HasSubstr("<img"));
}

TEST(ReplayPage, AsksTheNetworkNothingAndHoldsNoBlanks) {
  const std::string page = replay_page(known_replay("x", known_recording()));
  for (const char* outside : {"http:", "https:", "src=", "@import", "url(", "<link", "fetch(", "XMLHttpRequest"})
    EXPECT_THAT(page, Not(HasSubstr(outside)));
  for (const char* blank : {"{{", "@REPLAY"}) EXPECT_THAT(page, Not(HasSubstr(blank)));
  EXPECT_THAT(page, HasSubstr("prefers-color-scheme"));
  EXPECT_THAT(page, HasSubstr("webgl2"));
}

TEST(ReplayPage, WithoutTruthHasNoErrors) {
  const std::string page = replay_page(known_replay("x", known_recording(), false));
  EXPECT_THAT(page, Not(HasSubstr("actor0.errors")));
  EXPECT_THAT(page, HasSubstr("actor0.positions"));
  EXPECT_THAT(replay_page(known_replay("x", known_recording())), HasSubstr("actor0.errors")) << "negative control";
}

TEST(ReplayPage, OfALongRecordingStaysBelowThreeMegabytes) {
  sim::Recording recording = known_recording();
  sim::LidarRecord& lidar = recording.sensors.lidars[0];
  sim::LidarTruth& truth = recording.truth.lidars[0];
  for (int k = 0; k < 9; ++k) {  // 327 680 returns
    const auto points = lidar.position_L_m;
    const auto offsets = lidar.offset_ns;
    lidar.position_L_m.insert(lidar.position_L_m.end(), points.begin(), points.end());
    lidar.offset_ns.insert(lidar.offset_ns.end(), offsets.begin(), offsets.end());
  }
  lidar.sweep_first.back() = lidar.position_L_m.size();
  truth.surface_id.assign(lidar.position_L_m.size(), 0);
  const Replay replay = known_replay("x", recording);
  EXPECT_EQ(replay.points.of, 327'680u);
  EXPECT_GE(replay.points.p_B_m.size(), 100'000u);
  const std::size_t bytes = replay_page(replay).size();
  EXPECT_LE(bytes, 3'000'000u);
  EXPECT_GT(bytes, 1'000'000u) << "negative control: it holds the points";
}

}  // namespace
}  // namespace tumble::tools
