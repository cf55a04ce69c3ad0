// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/sphere_figures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble::tools {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

constexpr std::int64_t kPeriod_ns = 1'000'000;
constexpr double kSpeed_m_s = 0.5, kTremor_rad = 0.01;

/// Rests for a second, goes along x at a steady speed for two while it slips in the middle, up a step of 10 mm at the
/// end, rests for half a second.
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

/// `rolling` sees twice the way; `vqf` trembles by kTremor_rad from sample to sample.
SphereRoll sample_roll() {
  SphereRoll roll;
  scenarios::RunResult& run = roll.run;
  run.situation.scenario = "slip";
  run.situation.seed = 5001;
  run.recording = roll_recording();
  run.methods = {scenarios::find_methods("attitude/vqf").front(), scenarios::find_methods("position/rolling").front()};
  run.estimates.resize(2);
  run.estimates[1].frame = scenarios::Frame::centre;
  int sign = 1;
  for (const std::int64_t time_ns : run.recording.sensors.imus[0].time_ns) {
    const auto k = static_cast<std::size_t>(time_ns / kPeriod_ns);
    AttitudeState attitude;
    attitude.time_ns = time_ns;
    attitude.q_WA = Eigen::AngleAxisd(sign * kTremor_rad, Eigen::Vector3d(1.0, 1.0, 0.0).normalized());
    run.estimates[0].attitudes.push_back(attitude);
    sign = -sign;
    PoseState pose;
    pose.time_ns = time_ns;
    pose.p_WA_m = run.recording.truth.p_WB_m[k];
    pose.p_WA_m.x() *= 2.0;
    pose.q_WA = Eigen::Quaterniond::Identity();
    run.estimates[1].poses.push_back(pose);
  }
  return roll;
}

double last(const json& numbers) {
  return numbers.back().get<double>();
}

double largest(const json& numbers) {
  double most = 0.0;
  for (const json& number : numbers) most = std::max(most, std::abs(number.get<double>()));
  return most;
}

TEST(SphereFigures, ShowTheTrackBesideTheTruth) {
  const Figure figure = sphere_track_figure(sample_roll());
  ASSERT_EQ(figure.data.size(), 2u);
  EXPECT_EQ(figure.data[0]["name"], "truth");
  EXPECT_EQ(figure.data[1]["name"], "rolling");
  EXPECT_NEAR(last(figure.data[0]["x"]), 1.0, 0.01);
  EXPECT_NEAR(last(figure.data[1]["x"]), 2.0, 0.01);
  EXPECT_EQ(figure.layout["yaxis"]["scaleanchor"], "x");
}

TEST(SphereFigures, ShadeTheSlipAndTakeSpeedsAlike) {
  const Figure figure = sphere_speed_figure(sample_roll());
  ASSERT_EQ(figure.layout["shapes"].size(), 1u);
  EXPECT_NEAR(figure.layout["shapes"][0]["x0"].get<double>(), 1.5, 1e-6);
  EXPECT_NEAR(figure.layout["shapes"][0]["x1"].get<double>(), 1.8, 1e-6);
  ASSERT_EQ(figure.data.size(), 2u);
  // plateaus, but for the digits kept in the page
  EXPECT_NEAR(largest(figure.data[0]["y"]), kSpeed_m_s, 1e-4);
  EXPECT_NEAR(largest(figure.data[1]["y"]), 2.0 * kSpeed_m_s, 1e-4);
  // negative control: a roll that grips has nothing shaded
  SphereRoll grips = sample_roll();
  for (sim::ContactLabel& label : grips.run.recording.truth.label) label = sim::ContactLabel::grip;
  EXPECT_TRUE(sphere_speed_figure(grips).layout["shapes"].empty());
}

TEST(SphereFigures, ShowTheHeightFromTheStart) {
  const Figure figure = sphere_height_figure(sample_roll());
  EXPECT_NEAR(figure.data[0]["y"][0].get<double>(), 0.0, 1e-9);
  EXPECT_NEAR(last(figure.data[0]["y"]), 10.0, 1e-6) << "millimetres";
}

TEST(SphereFigures, ShowTheTremorAtStandstillOnly) {
  const Figure figure = sphere_standstill_figure(sample_roll());
  ASSERT_EQ(figure.data.size(), 2u);
  EXPECT_EQ(figure.data[0]["name"], "truth");
  EXPECT_NEAR(largest(figure.data[0]["y"]), 0.0, 1e-9);
  // all of it, whatever its direction; a mean of an odd number of samples is off by their share
  EXPECT_NEAR(largest(figure.data[1]["y"]), kTremor_rad * 180.0 / std::numbers::pi, 0.01);
  EXPECT_LT(last(figure.data[1]["x"]), 1.01) << "the longest rest is the first";
  SphereRoll none = sample_roll();
  none.run.methods.erase(none.run.methods.begin());
  none.run.estimates.erase(none.run.estimates.begin());
  EXPECT_TRUE(sphere_standstill_figure(none).empty());
}

TEST(SphereFigures, StandInTheirSection) {
  std::vector<Figure> figures;
  const std::string page = sphere_html({sample_roll()}, figures);
  EXPECT_EQ(figures.size(), 4u);
  for (const Figure& figure : figures) EXPECT_THAT(page, HasSubstr("id=\"" + figure.id + "\""));
  figures.clear();
  EXPECT_EQ(sphere_html({}, figures), "");
}

}  // namespace
}  // namespace tumble::tools
