// SPDX-License-Identifier: BSD-3-Clause
#include "tools/replay/replay.hpp"

#include "scenarios/errors.hpp"
#include "scenarios/methods/registry.hpp"
#include "tests/testing.hpp"
#include "tests/tools/replays.hpp"
#include "tools/replay/parts.hpp"
#include "tools/replay/run_replay.hpp"

namespace tumble::tools {
namespace {

using scenarios::Estimate;
using scenarios::Frame;
using testing::known_estimate;
using testing::known_pose;
using testing::known_recording;

double apart(const Isometry3d& a, const Isometry3d& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

Isometry3d mounting() {
  return Eigen::Translation3d(0.1, -0.05, 0.02) * Eigen::AngleAxisd(0.4, Vector3d(1, 1, 0).normalized());
}

TEST(ReplayMotion, GoesBetweenItsPosesAndNoFurther) {
  std::vector<std::int64_t> times;
  std::vector<Isometry3d> poses;
  for (std::int64_t t = 0; t <= 1'000'000'000; t += 100'000'000) {
    times.push_back(t);
    poses.push_back(known_pose(t));
  }
  times.push_back(1'050'000'000);  // an invalid pose is left out
  poses.push_back(Isometry3d(Eigen::Translation3d(Vector3d::Constant(std::nan("")))));
  times.push_back(3'000'000'000);
  poses.push_back(known_pose(3'000'000'000));
  const Motion motion(times, poses);
  // the body turns steadily about one axis at steady speed, so slerp and lerp are exact
  ASSERT_TRUE(motion.at(123'456'789));
  EXPECT_LT(apart(*motion.at(123'456'789), known_pose(123'456'789)), 1e-12);
  EXPECT_FALSE(motion.at(-1));
  EXPECT_FALSE(motion.at(3'000'000'001));
  EXPECT_FALSE(motion.at(2'000'000'000)) << "a gap of two seconds";
  EXPECT_TRUE(motion.at(3'000'000'000));
  EXPECT_FALSE(Motion().at(0));
}

TEST(ReplayMotion, OfAnEstimateIsMovedToTheTruth) {
  sim::Recording recording = known_recording();
  recording.sensors.imus[0].T_BI = recording.truth.imus[0].T_BI = mounting();
  const Estimate estimate = known_estimate(Frame::imu, mounting(), testing::other_world());
  const Motion motion = estimated_motion(estimate, recording.sensors, &recording.truth, {});
  ASSERT_FALSE(motion.empty());
  EXPECT_LT(apart(*motion.at(500'000'000), known_pose(500'000'000)), 1e-9);
  // negative control: with another mounting the motion differs
  recording.sensors.imus[0].T_BI.translation().x() += 0.1;
  const Motion other = estimated_motion(estimate, recording.sensors, &recording.truth, {});
  EXPECT_GT(apart(*other.at(500'000'000), known_pose(500'000'000)), 0.01);
  // there are frames of absent sensors, and no poses
  recording.sensors.lidars.clear();
  EXPECT_TRUE(
      estimated_motion(known_estimate(Frame::lidar, mounting(), mounting()), recording.sensors, nullptr, {}).empty());
  EXPECT_TRUE(estimated_motion({}, recording.sensors, &recording.truth, {}).empty());
}

TEST(ReplayMotion, WithoutTruthTheSecondIsMovedToTheFirst) {
  const sim::Recording recording = known_recording();
  const Motion first = estimated_motion(known_estimate(Frame::body, Isometry3d::Identity(), Isometry3d::Identity()),
                                        recording.sensors, nullptr, {});
  const Estimate elsewhere = known_estimate(Frame::body, Isometry3d::Identity(), testing::other_world());
  const Motion second = estimated_motion(elsewhere, recording.sensors, nullptr, first);
  EXPECT_LT(apart(*second.at(700'000'000), *first.at(700'000'000)), 1e-9);
  EXPECT_GT(apart(*estimated_motion(elsewhere, recording.sensors, nullptr, {}).at(700'000'000), *first.at(700'000'000)),
            1.0)
      << "negative control";
}

TEST(ReplayMotion, OfAReferenceWithoutPlacesIsEmpty) {
  sim::Truth truth = testing::known_truth();
  EXPECT_FALSE(true_motion(truth, truth.period_ns).empty());
  for (Vector3d& p : truth.p_WB_m) p.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(true_motion(truth, truth.period_ns).empty());
}

TEST(ReplayPoints, AreSpreadEvenlyOverBeamsAndSweeps) {
  const sim::Recording recording = known_recording();
  const ReplayPoints all = shown_points(recording.sensors, &recording.truth, 10'000);
  EXPECT_EQ(all.p_B_m.size(), 640u);
  EXPECT_EQ(all.of, 640u);
  const ReplayPoints some = shown_points(recording.sensors, &recording.truth, 160);
  ASSERT_LE(some.p_B_m.size(), 160u);
  EXPECT_GE(some.p_B_m.size(), 155u);
  std::array<int, 16> of_beam = {};
  int in_first_sweep = 0;
  for (std::size_t i = 0; i < some.p_B_m.size(); ++i) {
    // the x coordinate tells which return the point is
    const auto index = static_cast<std::size_t>(std::lround((some.p_B_m[i].x() - 0.6f) / 0.001f));
    ++of_beam[index % 16];
    in_first_sweep += index < 320 ? 1 : 0;
    EXPECT_GE(some.time_ns[i], some.time_ns[i == 0 ? 0 : i - 1]);
  }
  // each beam has a quarter of 40, one more or less in each round: 16 steps of the ratio are a ninth of a turn, 40 of
  // them 4.5 rounds
  for (const int count : of_beam) EXPECT_NEAR(count, 10, 5);
  EXPECT_NEAR(in_first_sweep, 80, 3);
}

TEST(ReplayPoints, LeaveTheRobotsOwnOut) {
  sim::Recording recording = known_recording();
  for (std::size_t i = 0; i < 100; ++i) recording.truth.lidars[0].surface_id[i] = -2;
  EXPECT_EQ(shown_points(recording.sensors, &recording.truth, 10'000).of, 540u);
  recording.sensors.lidars[0].position_L_m[300] = Vector3f(0.1f, 0.0f, 0.0f);
  recording.sensors.lidars[0].position_L_m[301] = Vector3f::Constant(std::nanf(""));
  EXPECT_EQ(shown_points(recording.sensors, nullptr, 10'000).of, 638u) << "without truth what is near";
  recording.sensors.lidars.clear();
  EXPECT_TRUE(shown_points(recording.sensors, nullptr, 10).p_B_m.empty());
}

TEST(ReplayPoints, ErrorsAreDistancesFromTheTrueSurface) {
  const sim::Recording recording = known_recording();
  const sim::Surface floor(testing::room());
  const ReplayPoints points = shown_points(recording.sensors, &recording.truth, 10'000);
  const Motion truth = true_motion(recording.truth, recording.truth.period_ns);
  const std::vector<float> exact = errors_of(points, truth, Isometry3d::Identity(), floor);
  for (std::size_t i = 0; i < exact.size(); ++i) EXPECT_NEAR(exact[i], i % 32 < 16 ? 0.0f : 0.25f, 1e-4f);
  const Isometry3d lifted(Eigen::Translation3d(0, 0, 0.1));
  EXPECT_NEAR(errors_of(points, truth, lifted, floor)[0], 0.1f, 1e-4f);
  EXPECT_TRUE(std::isnan(errors_of(points, {}, Isometry3d::Identity(), floor)[0])) << "nobody knows where";
}

TEST(ReplayStrip, MarksWhatIsClippedAndWhatTouches) {
  const sim::Recording recording = known_recording();
  const ReplayStrip strip = strip_of(recording.sensors, &recording.truth, {}, 1000);
  ASSERT_EQ(strip.time_ns.size(), 101u);
  EXPECT_EQ(strip.clipping, "the truth");
  for (std::size_t k = 0; k < 101; ++k) EXPECT_EQ(strip.clipped_axes[k], k >= 40 && k < 60 ? 4 : 0) << k;
  ASSERT_EQ(strip.contacts.size(), 1u);
  EXPECT_EQ(strip.contacts[0].begin_ns, 200'000'000);
  EXPECT_EQ(strip.contacts[0].end_ns, 300'000'000);
  EXPECT_EQ(strip.contacts[0].label, sim::ContactLabel::slip);
  sim::Recording rig = recording;
  rig.sensors.sphere_radius_m = 0.0;
  EXPECT_EQ(strip_of(rig.sensors, &rig.truth, {}, 1000).contacts[0].label, sim::ContactLabel::grip);
}

TEST(ReplayStrip, WithoutTruthAsksTheDeviceThenAnEstimate) {
  sim::Recording recording = known_recording();
  const Estimate estimate = known_estimate(Frame::body, Isometry3d::Identity(), Isometry3d::Identity());
  const ReplayStrip by_estimate = strip_of(recording.sensors, nullptr, {{"rate/x", &estimate}}, 1000);
  EXPECT_EQ(by_estimate.clipping, "rate/x");
  EXPECT_EQ(by_estimate.clipped_axes[80], 4);
  EXPECT_EQ(by_estimate.clipped_axes[30], 0);
  EXPECT_FALSE(by_estimate.contacts_known);
  recording.sensors.imus[0].clip_flags[7] = 1 | 8;
  const ReplayStrip by_device = strip_of(recording.sensors, nullptr, {{"rate/x", &estimate}}, 1000);
  EXPECT_EQ(by_device.clipping, "the device");
  EXPECT_EQ(by_device.clipped_axes[7], 1) << "the gyro's bits alone";
  recording.sensors.imus[0].clip_flags.assign(101, 0);
  EXPECT_EQ(strip_of(recording.sensors, nullptr, {}, 1000).clipping, "") << "nobody says so";
}

TEST(ReplayStrip, KeepsTheFastestOfEachRun) {
  sim::Recording recording = known_recording();
  recording.sensors.imus[0].gyro_rad_s[33].x() = 30.0;
  const ReplayStrip strip = strip_of(recording.sensors, &recording.truth, {}, 11);
  ASSERT_LE(strip.time_ns.size(), 11u);
  EXPECT_EQ(strip.of, 101u);
  float fastest = 0.0f;
  for (const Vector3f& rate : strip.gyro_rad_s) fastest = std::max(fastest, rate.norm());
  EXPECT_GT(fastest, 29.0f);
  EXPECT_EQ(true_rates(strip, recording.sensors, recording.truth).size(), strip.time_ns.size());
}

TEST(ReplayStrip, RatesOfAnEstimateAreNotKnownWhereItHasNone) {
  const sim::Recording recording = known_recording();
  const Estimate estimate = known_estimate(Frame::body, Isometry3d::Identity(), Isometry3d::Identity());
  const ReplayStrip strip = strip_of(recording.sensors, nullptr, {}, 1000);
  const std::vector<Vector3f> rates = estimated_rates(strip, recording.sensors, estimate);
  EXPECT_TRUE(std::isnan(rates[5].z()));
  EXPECT_FLOAT_EQ(rates[50].z(), 3.0f);
  EXPECT_TRUE(estimated_rates(strip, recording.sensors, {}).empty());
}

/// Returns a level field of 0.1 m cells over 20 m by 20 m.
sim::MeshPart wide_field() {
  sim::MeshPart field;
  field.rows = field.columns = 201;
  for (int r = 0; r < 201; ++r) {
    for (int c = 0; c < 201; ++c)
      field.vertices_m.emplace_back(-10.0f + 0.1f * static_cast<float>(c), -10.0f + 0.1f * static_cast<float>(r), 0.0f);
  }
  return field;
}

sim::MeshPart stone(const Vector3f& at, float size) {
  sim::MeshPart part;
  part.vertices_m = {at, at + Vector3f(size, 0, 0), at + Vector3f(0, size, 0)};
  part.triangles = {{0, 1, 2}};
  return part;
}

TEST(ReplayWorld, IsWholeNearThePathAndFitsItsLimit) {
  const Eigen::AlignedBox3f near(Vector3f(-1, -1, -1), Vector3f(1, 1, 1));
  Shown triangles;
  const std::vector<sim::MeshPart> thin = thinned_world({wide_field()}, near, 40'000, triangles);
  ASSERT_EQ(thin.size(), 1u);
  EXPECT_EQ(triangles.of, 80'000u);
  EXPECT_EQ(triangles.shown, triangle_count(thin[0]));
  EXPECT_LE(triangles.shown, 30'000u) << "three quarters";
  EXPECT_EQ(thin[0].vertices_m.size(), static_cast<std::size_t>(thin[0].rows * thin[0].columns));
  int near_columns = 0;
  for (int c = 0; c < thin[0].columns; ++c) {
    const float x = thin[0].vertices_m[static_cast<std::size_t>(c)].x();
    near_columns += x > -1.01f && x < 1.01f ? 1 : 0;
  }
  EXPECT_EQ(near_columns, 21) << "every node within the box";
  EXPECT_EQ(thin[0].vertices_m.front(), wide_field().vertices_m.front());
  EXPECT_EQ(thin[0].vertices_m.back(), wide_field().vertices_m.back());
  EXPECT_LE(triangle_count(thinned_world({wide_field()}, near, 400, triangles)[0]), 300u) << "coarser at need";
}

TEST(ReplayWorld, KeepsWhatIsLargeForItsDistance) {
  const Eigen::AlignedBox3f near(Vector3f(-1, -1, -1), Vector3f(1, 1, 1));
  Shown triangles;
  const auto kept =
      thinned_world({stone({50, 0, 0}, 0.1f), stone({2, 0, 0}, 0.1f), stone({30, 0, 0}, 20.0f)}, near, 2, triangles);
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(triangles.shown, 2u);
  EXPECT_EQ(triangles.of, 3u);
  EXPECT_EQ(kept[0].vertices_m[0].x(), 2.0f);
  EXPECT_EQ(kept[1].vertices_m[0].x(), 30.0f);
  EXPECT_TRUE(thinned_world({}, near, 10, triangles).empty());
}

TEST(ReplayWorld, PlainBodyHasItsSize) {
  const auto ball = plain_body(0.145);
  ASSERT_EQ(ball.size(), 1u);
  for (const Vector3f& vertex : ball[0].vertices_m) EXPECT_NEAR(vertex.norm(), 0.145f, 1e-6f);
  EXPECT_FALSE(plain_body(0.0)[0].triangles.empty());
}

ReplayInput input_of(const sim::Recording& recording) {
  ReplayInput input;
  input.title = "test";
  input.sensors = &recording.sensors;
  input.truth = &recording.truth;
  return input;
}

TEST(ReplayModel, HoldsTruthAndEstimatesAtTheirTimes) {
  const sim::Recording recording = known_recording();
  const sim::Surface surface(testing::room());
  const Estimate estimate = known_estimate(Frame::body, Isometry3d::Identity(), testing::other_world());
  ReplayInput input = input_of(recording);
  input.built = &testing::room();
  input.surface = &surface;
  input.estimates = {{"slam/x", &estimate}};
  const Replay replay = replay_of(input);
  ASSERT_EQ(replay.actors.size(), 2u);
  EXPECT_TRUE(replay.actors[0].is_truth);
  EXPECT_EQ(replay.actors[1].name, "slam/x");
  EXPECT_NE(replay.actors[0].colour, replay.actors[1].colour);
  EXPECT_EQ(replay.end_ns, 1'000'000'000);
  const auto k = static_cast<std::size_t>(500'000'000 / replay.pose_step_ns);
  const Vector3d expected = known_pose(static_cast<std::int64_t>(k) * replay.pose_step_ns).translation();
  for (const ReplayActor& actor : replay.actors) {
    EXPECT_LT((actor.track.p_WB_m[k] - expected).norm(), 1e-9);
    ASSERT_EQ(actor.error_m.size(), replay.points.p_B_m.size());
    EXPECT_NEAR(actor.error_m[0], 0.0f, 1e-4f);
    EXPECT_EQ(actor.rate_rad_s.size(), replay.strip.time_ns.size());
  }
  EXPECT_FALSE(replay.world.empty());
  EXPECT_NEAR(replay.robot_radius_m, 0.145, 0.02);
}

TEST(ReplayModel, WorksWithoutTruthAndWithoutWorld) {
  const sim::Recording recording = known_recording();
  const Estimate estimate = known_estimate(Frame::body, Isometry3d::Identity(), testing::other_world());
  ReplayInput input = input_of(recording);
  input.truth = nullptr;
  input.estimates = {{"slam/x", &estimate}};
  const Replay replay = replay_of(input);
  ASSERT_EQ(replay.actors.size(), 1u);
  EXPECT_FALSE(replay.actors[0].is_truth);
  EXPECT_TRUE(replay.actors[0].error_m.empty()) << "nobody knows the surface";
  EXPECT_FALSE(replay.points.p_B_m.empty());
  EXPECT_TRUE(replay.world.empty());
  EXPECT_FALSE(replay.robot.empty());
  EXPECT_EQ(replay.from_ns, 0);
}

TEST(ReplayModel, RefusesWhatShowsNothing) {
  sim::Recording recording = known_recording();
  ReplayInput input = input_of(recording);
  input.truth = nullptr;
  EXPECT_THROW(replay_of(input), scenarios::BadInput) << "no path at all";
  const Estimate rates_alone = [] {
    Estimate estimate = known_estimate(Frame::body, Isometry3d::Identity(), Isometry3d::Identity());
    estimate.poses.clear();
    return estimate;
  }();
  input.estimates = {{"rate/x", &rates_alone}};
  EXPECT_THROW(replay_of(input), scenarios::BadInput);
  input.truth = &recording.truth;
  EXPECT_NO_THROW(replay_of(input)) << "the truth's path and the rates";
  recording.sensors.lidars[0].offset_ns.pop_back();
  EXPECT_THROW(replay_of(input), scenarios::BadInput) << "a point without a time";
}

TEST(ReplayModel, KeepsToItsBytes) {
  const sim::Recording recording = known_recording();
  ReplayLimits limits;
  limits.bytes = 12'000;
  const Replay small = replay_of(input_of(recording), limits);
  EXPECT_LT(small.points.p_B_m.size(), 640u);
  EXPECT_EQ(small.points.of, 640u);
  std::size_t bytes = 10 * small.points.p_B_m.size() + 20 * small.actors[0].track.p_WB_m.size();
  bytes += 17 * small.strip.time_ns.size();
  for (const sim::MeshPart& part : small.robot) bytes += 6 * (part.vertices_m.size() + part.triangles.size());
  EXPECT_LE(bytes, limits.bytes);
  EXPECT_EQ(replay_of(input_of(recording)).points.p_B_m.size(), 640u) << "negative control";
}

TEST(ReplayOfARun, ShowsBaselinesAndOursBeforeOthersAndNoOracle) {
  scenarios::RunResult run;
  for (const scenarios::Method& method : scenarios::methods()) {
    run.methods.push_back(scenarios::unowned(method));
    run.estimates.push_back(known_estimate(Frame::body, Isometry3d::Identity(), Isometry3d::Identity()));
  }
  const std::vector<std::size_t> shown = shown_methods(run);
  ASSERT_EQ(shown.size(), kRunReplayMethods);
  std::vector<std::string> names;
  for (const std::size_t i : shown) {
    const scenarios::MethodInfo& info = run.methods[i]->info;
    EXPECT_FALSE(info.needs_truth);
    names.push_back(std::string(to_string(info.kind)) + "/" + info.name);
  }
  for (const char* lead : {"rate/raw", "rate/tumble", "slam/icp_raw", "slam/tumble"})
    EXPECT_NE(std::find(names.begin(), names.end(), lead), names.end()) << lead;
  EXPECT_TRUE(std::is_sorted(shown.begin(), shown.end()));
  run.estimates.assign(run.methods.size(), Estimate());
  EXPECT_TRUE(shown_methods(run).empty()) << "nothing to show of any";
}

}  // namespace
}  // namespace tumble::tools
