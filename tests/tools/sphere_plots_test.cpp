// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/registry.hpp"
#include "tests/testing.hpp"
#include "tools/examples/draw_plots.hpp"

namespace tumble::tools {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;
constexpr double kSpeed_m_s = 0.5, kTremor_rad = 0.01;

/// Returns a sphere that rests for a second, moves along x at a steady speed for two while it slips in the middle,
/// climbs a step of 10 mm at the end, and rests for half a second.
sim::Recording roll_recording() {
  sim::Recording recording;
  sim::Truth& truth = recording.truth;
  truth.period_ns = kPeriod_ns;
  for (int k = 0; k <= 3500; ++k) {
    const double t = std::clamp(k * 1e-3 - 1.0, 0.0, 2.0);
    const bool moves = k > 1000 && k <= 3000;
    truth.p_WB_m.emplace_back(kSpeed_m_s * t, 0.0, k > 2900 ? 0.155 : 0.145);
    truth.q_WB.push_back(Eigen::Quaterniond::Identity());
    truth.v_WB_m_s.emplace_back(moves ? kSpeed_m_s : 0.0, 0.0, 0.0);
    truth.w_WB_B_rad_s.push_back(Eigen::Vector3d::Zero());
    truth.label.push_back(k >= 1500 && k < 1800 ? sim::ContactLabel::slip : sim::ContactLabel::grip);
  }
  sim::ImuRecord imu;
  imu.period_ns = 4'000'000;
  for (std::int64_t time_ns = imu.period_ns; time_ns <= 3'500'000'000; time_ns += imu.period_ns)
    imu.time_ns.push_back(time_ns);
  recording.sensors.imus = {imu};
  recording.sensors.sphere_radius_m = 0.145;
  truth.imus.resize(1);
  return recording;
}

/// Returns a result in which `rolling` measures twice the path, and the attitude of `vqf` varies by kTremor_rad from
/// sample to sample.
scenarios::RunResult sample_roll() {
  scenarios::RunResult run;
  run.scenario = "slip";
  run.seed = 5001;
  run.recording = roll_recording();
  run.methods = {scenarios::find_methods("attitude/vqf").front(), scenarios::find_methods("position/rolling").front()};
  run.estimates.resize(2);
  run.estimates[1].frame = scenarios::Frame::centre;
  int sign = 1;
  for (const std::int64_t time_ns : run.recording.sensors.imus[0].time_ns) {
    const auto k = static_cast<std::size_t>(time_ns / kPeriod_ns);
    AttitudeState attitude;
    attitude.time_ns = time_ns;
    attitude.orientation_W = Eigen::AngleAxisd(sign * kTremor_rad, Vector3d(1.0, 1.0, 0.0).normalized());
    run.estimates[0].attitudes.push_back(attitude);
    sign = -sign;
    PoseState pose;
    pose.time_ns = time_ns;
    pose.position_W_m = run.recording.truth.p_WB_m[k];
    pose.position_W_m.x() *= 2.0;
    pose.orientation_W = Eigen::Quaterniond::Identity();
    run.estimates[1].poses.push_back(pose);
  }
  return run;
}

double last(const std::vector<double>& numbers) {
  return numbers.back();
}

double largest(const std::vector<double>& numbers) {
  double most = 0.0;
  for (const double number : numbers) most = std::max(most, std::abs(number));
  return most;
}

TEST(SpherePlots, ShowTheTrackBesideTheTruth) {
  const Plot plot = sphere_track_plot(sample_roll());
  ASSERT_EQ(plot.lines.size(), 2u);
  EXPECT_EQ(plot.lines[0].name, "truth");
  EXPECT_EQ(plot.lines[1].name, "rolling");
  EXPECT_NEAR(last(plot.lines[0].x), 1.0, 0.01);
  EXPECT_NEAR(last(plot.lines[1].x), 2.0, 0.01);
  EXPECT_TRUE(plot.equal_scales);
}

TEST(SpherePlots, ShadeTheSlipAndTakeSpeedsAlike) {
  const Plot plot = sphere_speed_plot(sample_roll());
  ASSERT_EQ(plot.shaded.size(), 1u);
  EXPECT_NEAR(plot.shaded[0].first, 1.5, 1e-6);
  EXPECT_NEAR(plot.shaded[0].second, 1.8, 1e-6);
  ASSERT_EQ(plot.lines.size(), 2u);
  // the plateaus are exact except for the digits kept in the page
  EXPECT_NEAR(largest(plot.lines[0].y), kSpeed_m_s, 1e-4);
  EXPECT_NEAR(largest(plot.lines[1].y), 2.0 * kSpeed_m_s, 1e-4);
  // negative control: a roll without slip has no shaded period
  scenarios::RunResult grips = sample_roll();
  for (sim::ContactLabel& label : grips.recording.truth.label) label = sim::ContactLabel::grip;
  EXPECT_TRUE(sphere_speed_plot(grips).shaded.empty());
}

TEST(SpherePlots, ShowTheHeightFromTheStart) {
  const Plot plot = sphere_height_plot(sample_roll());
  EXPECT_NEAR(plot.lines[0].y[0], 0.0, 1e-9);
  EXPECT_NEAR(last(plot.lines[0].y), 10.0, 1e-6) << "millimetres";
}

TEST(SpherePlots, ShowTheTremorAtStandstillOnly) {
  const Plot plot = sphere_standstill_plot(sample_roll());
  ASSERT_EQ(plot.lines.size(), 2u);
  EXPECT_EQ(plot.lines[0].name, "truth");
  EXPECT_NEAR(largest(plot.lines[0].y), 0.0, 1e-9);
  // the plot shows the whole tremor, whatever its direction; a mean of an odd number of samples is wrong by their share
  EXPECT_NEAR(largest(plot.lines[1].y), kTremor_rad * 180.0 / std::numbers::pi, 0.01);
  EXPECT_LT(last(plot.lines[1].x), 1.01) << "the longest rest is the first";
  scenarios::RunResult none = sample_roll();
  none.methods.erase(none.methods.begin());
  none.estimates.erase(none.estimates.begin());
  EXPECT_TRUE(sphere_standstill_plot(none).lines.empty());
}

TEST(SpherePlots, ShowOneMethodOfEachOriginAndNoOracle) {
  scenarios::RunResult run = sample_roll();
  for (const char* name : {"position/oracle", "position/tumble", "position/tumble_lag"}) {
    run.methods.push_back(scenarios::find_methods(name).front());
    run.estimates.push_back(run.estimates[1]);
  }
  const Plot plot = sphere_track_plot(run);
  ASSERT_EQ(plot.lines.size(), 3u);
  EXPECT_EQ(plot.lines[1].name, "rolling");
  EXPECT_EQ(plot.lines[2].name, "tumble") << "the first of ours; the oracle is given the truth";
}

}  // namespace
}  // namespace tumble::tools
