// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "live_readings.hpp"
#include "thrown_body.hpp"
#include "thrown_params.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/odometry/expert_params.hpp"
#include "tumble/tumble.hpp"

namespace tumble {
namespace {

using test::ThrownBody;

constexpr TimeNs kSweep_ns = 100'000'000;

struct Answers {
  std::vector<TumblingOdometry::Sweep> sweeps;
  std::vector<TimeNs> came_ns;  ///< IMU time at which take() returned each sweep
  std::vector<AngularRateState> rates;
};

/// Passes the samples `from` to `to` - 1, and each sweep as soon as the sweep has ended.
void feed_as_they_end(const std::vector<ImuSample>& imu, const std::vector<ThrownBody::Sweep>& sweeps, std::size_t from,
                      std::size_t to, TumblingOdometry& odometry, Answers& run) {
  for (std::size_t k = from; k < to; ++k) {
    ASSERT_TRUE(odometry.add_imu(imu[k]).ok());
    const TimeNs before_ns = k == 0 ? 0 : imu[k - 1].time_ns;
    for (const ThrownBody::Sweep& sweep : sweeps) {
      if (sweep.end_ns > before_ns && sweep.end_ns <= imu[k].time_ns) {
        ASSERT_TRUE(odometry.add_sweep(sweep.start_ns, sweep.end_ns, sweep.points).ok());
      }
    }
    while (std::optional<TumblingOdometry::Sweep> sweep = odometry.take()) {
      run.sweeps.push_back(std::move(*sweep));
      run.came_ns.push_back(imu[k].time_ns);
    }
    const std::optional<AngularRateState>& rate = odometry.newest_smoothed_rate();
    if (rate && (run.rates.empty() || rate->time_ns > run.rates.back().time_ns)) run.rates.push_back(*rate);
  }
}

Answers whole(const ThrownBody& body, TumblingOdometry& odometry) {
  Answers run;
  const std::vector<ImuSample> imu = body.imu();
  feed_as_they_end(imu, body.sweeps(), 0, imu.size(), odometry, run);
  odometry.finish();
  while (std::optional<TumblingOdometry::Sweep> sweep = odometry.take()) {
    run.sweeps.push_back(std::move(*sweep));
    run.came_ns.push_back(imu.back().time_ns);
  }
  return run;
}

struct ThrownRun {
  TumblingOdometry odometry;
  Answers results;
};

/// Returns the run on the default body, which several tests use.
const ThrownRun& thrown_run() {
  static const ThrownRun run = [] {
    const ThrownBody body;
    ThrownRun out{TumblingOdometry(params_of(body)), {}};
    out.results = whole(body, out.odometry);
    return out;
  }();
  return run;
}

double position_error_m(const ThrownBody& body, const PoseState& pose) {
  return (pose.position_W_m - body.T_WI(seconds(pose.time_ns)).translation()).norm();
}
double attitude_error_rad(const ThrownBody& body, const PoseState& pose) {
  return pose.orientation_W.angularDistance(Eigen::Quaterniond(body.T_WI(seconds(pose.time_ns)).linear()));
}

TEST(TumblingOdometry, FollowsAThrowBeyondTheRail) {
  const ThrownBody body;
  const auto& [odometry, run] = thrown_run();
  ASSERT_EQ(run.sweeps.size(), body.sweeps().size());
  for (const TumblingOdometry::Sweep& sweep : run.sweeps) EXPECT_TRUE(sweep.status.ok()) << sweep.status.message();
  // the returns have no noise, so the errors come from the map's planes and from the deskewing
  EXPECT_LT(position_error_m(body, run.sweeps.back().result.pose), 0.02);
  EXPECT_LT(attitude_error_rad(body, run.sweeps.back().result.pose), 0.01);
  double worst_m = 0.0;
  for (const TumblingOdometry::Sweep& sweep : run.sweeps)
    worst_m = std::max(worst_m, position_error_m(body, sweep.result.pose));
  EXPECT_LT(worst_m, 0.1);
  EXPECT_GT(odometry.mapper().map().size(), 1000u);
}

TEST(TumblingOdometry, AClippedGyroAloneLosesTheSame) {  // negative control: without recovered rates, tracking fails
  const ThrownBody body;
  LidarInertialOdometry::Params params;
  params.own_body_L = {};
  LidarInertialOdometry mapper(params);
  const std::vector<ImuSample> imu = body.imu();
  std::size_t next = 0;
  LidarInertialOdometry::SweepResult report;
  for (const ThrownBody::Sweep& sweep : body.sweeps()) {
    for (; next < imu.size() && imu[next].time_ns <= sweep.end_ns; ++next) {
      AngularRateState rate;
      rate.time_ns = imu[next].time_ns;
      rate.w_WI_I_rad_s = imu[next].angular_velocity_rad_s;
      ASSERT_TRUE(mapper.add_imu(imu[next], rate).ok());
    }
    mapper.add_sweep(sweep.start_ns, sweep.end_ns, sweep.points, report);
  }
  EXPECT_GT(position_error_m(body, report.pose) + attitude_error_rad(body, report.pose), 0.3);
}

TEST(TumblingOdometry, RecoversTheRateInFlight) {
  const ThrownBody body;
  const Answers& run = thrown_run().results;
  // the test covers the flight, except the start and the last quarter second, in which the stream already uses samples
  // of the gentle catch
  const double from_s = body.rest_s + body.push_s + 0.1, to_s = body.rest_s + body.push_s + body.flight_s - 0.25;
  int clipped = 0;
  for (const AngularRateState& rate : run.rates) {
    const double t_s = seconds(rate.time_ns);
    if (t_s < from_s || t_s > to_s) continue;
    clipped += rate.clipped_axes != 0;
    // a spin about one axis does not improve the lever arm, which is stated within a centimetre; of 3.5 rad/s, 0.87
    // rad/s remain
    const Eigen::Vector3d error = rate.w_WI_I_rad_s - body.w_WI_I_rad_s(t_s);
    EXPECT_LT(error.norm(), 0.3 * (body.spin_rad_s * body.axis.y() - body.rail_rad_s)) << t_s;
    EXPECT_LT(error.dot(rate.covariance_rad2_s2.ldlt().solve(error)), 14.2)
        << t_s;  // 99.7 % quantile of chi-square with three degrees of freedom
  }
  EXPECT_GT(clipped, 30);
}

TEST(TumblingOdometry, TheWordsComeInTime) {
  const ThrownBody body;
  const TumblingOdometry::Params params = params_of(body);
  const TimeNs sample_ns = static_cast<TimeNs>(1e9 / body.imu_hz), lag_ns = static_cast<TimeNs>(1e9 * params.lag_s);
  for (const TimeNs later_ns :
       {TimeNs{0}, TimeNs{4'000'000}, TimeNs{9'999'999}}) {  // delay of the samples relative to the ends of sweeps
    TumblingOdometry odometry(params);
    std::vector<ImuSample> imu = body.imu();
    for (ImuSample& sample : imu) sample.time_ns += later_ns;
    Answers run;
    feed_as_they_end(imu, body.sweeps(), 0, imu.size(), odometry, run);
    ASSERT_GT(run.sweeps.size(), 20u);
    for (std::size_t k = 0; k < run.sweeps.size(); ++k) {
      if (!run.sweeps[k].status.ok()) continue;  // the sweep began before the first IMU sample
      const TimeNs end_ns = run.sweeps[k].result.pose.time_ns, late_ns = run.came_ns[k] - end_ns;
      EXPECT_TRUE(late_ns >= lag_ns - sample_ns && late_ns <= lag_ns) << later_ns << ' ' << late_ns;
      if (k < 1 || !run.sweeps[k - 1].status.ok()) continue;  // each sweep reports the final poses of the previous one
      ASSERT_FALSE(run.sweeps[k].result.final_poses_of_earlier_sweep.empty());
      EXPECT_EQ(run.sweeps[k].result.final_poses_of_earlier_sweep.back().time_ns, end_ns - kSweep_ns);
    }
  }
}

TEST(TumblingOdometry, TheNewestPoseIsCausalAndHonest) {
  const ThrownBody body;
  TumblingOdometry odometry(params_of(body));
  const std::vector<ImuSample> imu = body.imu();
  PoseState pose;
  EXPECT_EQ(odometry.newest(pose).error_code, ErrorCode::empty);
  Answers results;
  double worst_m = 0.0, worst_nees = 0.0;
  for (std::size_t k = 0; k < imu.size(); k += 10) {
    feed_as_they_end(imu, body.sweeps(), k, std::min(k + 10, imu.size()), odometry, results);
    if (results.sweeps.empty()) continue;
    ASSERT_TRUE(odometry.newest(pose).ok());
    EXPECT_EQ(pose.time_ns, imu[std::min(k + 10, imu.size()) - 1].time_ns);
    const Eigen::Vector3d error = pose.position_W_m - body.T_WI(seconds(pose.time_ns)).translation();
    worst_m = std::max(worst_m, error.norm());
    worst_nees = std::max(worst_nees, error.dot(pose.covariance.topLeftCorner<3, 3>().ldlt().solve(error)));
  }
  EXPECT_LT(worst_m, 0.5);
  EXPECT_LT(worst_nees, 20.0);
}

TEST(TumblingOdometry, ACopyGoesOnWithTheSameBits) {
  const ThrownBody body;
  const Answers& run = thrown_run().results;
  const std::vector<ImuSample> imu = body.imu();
  for (const std::size_t split : {std::size_t{90}, imu.size() / 2 + 3}) {
    Answers parts;
    TumblingOdometry first(params_of(body));
    feed_as_they_end(imu, body.sweeps(), 0, split, first, parts);
    TumblingOdometry second(first);
    feed_as_they_end(imu, body.sweeps(), split, imu.size(), second, parts);
    second.finish();
    while (std::optional<TumblingOdometry::Sweep> sweep = second.take()) parts.sweeps.push_back(std::move(*sweep));
    ASSERT_EQ(parts.sweeps.size(), run.sweeps.size());
    for (std::size_t k = 0; k < run.sweeps.size(); ++k) {
      EXPECT_EQ(parts.sweeps[k].result.pose.position_W_m, run.sweeps[k].result.pose.position_W_m);
      EXPECT_EQ(parts.sweeps[k].result.pose.orientation_W.coeffs(), run.sweeps[k].result.pose.orientation_W.coeffs());
      EXPECT_EQ(parts.sweeps[k].result.pose.covariance, run.sweeps[k].result.pose.covariance);
    }
  }
}

TEST(TumblingOdometry, GoesOnAfterAGapBeyondTheStreamsBound) {
  ThrownBody body;
  body.rest_s = 4.2;  // the body is thrown after the gap
  body.end_s = 6.5;
  TumblingOdometry odometry(params_of(body));
  std::vector<ImuSample> imu = body.imu();
  std::vector<ThrownBody::Sweep> sweeps = body.sweeps();
  std::erase_if(imu, [](const ImuSample& s) { return s.time_ns > 1'500'000'000 && s.time_ns < 3'200'000'000; });
  std::erase_if(sweeps, [](const auto& s) { return s.end_ns > 1'500'000'000 && s.start_ns < 3'200'000'000; });
  Answers results;
  feed_as_they_end(imu, sweeps, 0, 150, odometry, results);
  // a single wrong time stamp causes the loss of one sample
  ImuSample wrong = imu[149];
  wrong.time_ns = 3'600'000'000'000;
  EXPECT_EQ(odometry.add_imu(wrong).error_code, ErrorCode::gap);
  EXPECT_EQ(odometry.add_imu(imu[150]).error_code, ErrorCode::gap);
  EXPECT_EQ(odometry.restart_count(), 0u);
  ASSERT_TRUE(odometry.add_imu(imu[151]).ok());
  EXPECT_EQ(odometry.restart_count(), 1u);
  feed_as_they_end(imu, sweeps, 152, imu.size(), odometry, results);
  EXPECT_EQ(odometry.samples_rejected_by_mapper(), 0u);
  odometry.finish();
  while (std::optional<TumblingOdometry::Sweep> sweep = odometry.take()) results.sweeps.push_back(std::move(*sweep));
  EXPECT_EQ(results.sweeps.size(), sweeps.size());
  EXPECT_LT(position_error_m(body, results.sweeps.back().result.pose), 0.1);
  EXPECT_LT(attitude_error_rad(body, results.sweeps.back().result.pose), 0.05);
}

TEST(TumblingOdometry, GoesOnAfterItWasFinished) {
  ThrownBody body;
  body.rest_s = 2.5;
  body.end_s = 4.8;
  const std::vector<ImuSample> imu = body.imu();
  const std::vector<ThrownBody::Sweep> sweeps = body.sweeps();
  TumblingOdometry odometry(params_of(body));
  Answers results;
  feed_as_they_end(imu, sweeps, 0, 200, odometry, results);
  odometry.finish();
  odometry.finish();
  ASSERT_TRUE(odometry.newest_smoothed_rate());
  EXPECT_EQ(odometry.newest_smoothed_rate()->time_ns, imu[199].time_ns);
  PoseState pose;
  EXPECT_TRUE(odometry.newest(pose).ok());
  EXPECT_EQ(odometry.add_imu(imu[199]).error_code, ErrorCode::time_order);
  feed_as_they_end(imu, sweeps, 200, imu.size(), odometry, results);
  odometry.finish();
  while (std::optional<TumblingOdometry::Sweep> sweep = odometry.take()) results.sweeps.push_back(std::move(*sweep));
  EXPECT_EQ(results.sweeps.size(), sweeps.size());
  EXPECT_EQ(odometry.samples_rejected_by_mapper(), 0u);
  EXPECT_LT(position_error_m(body, results.sweeps.back().result.pose), 0.1);
}

TEST(TumblingOdometry, ALidarThatFallsSilentIsMadeUpForByInertia) {
  ThrownBody body;
  body.rest_s = 9.0;
  body.end_s = 6.0;  // the body is always at rest
  const std::vector<ImuSample> imu = body.imu();
  std::vector<ThrownBody::Sweep> sweeps = body.sweeps();
  std::erase_if(sweeps, [](const ThrownBody::Sweep& sweep) { return sweep.end_ns > 1'500'000'000; });
  TumblingOdometry odometry(params_of(body));
  Answers results;
  feed_as_they_end(imu, sweeps, 0, imu.size(), odometry, results);
  const auto made_up = std::count_if(results.sweeps.begin(), results.sweeps.end(),
                                     [](const auto& sweep) { return sweep.status.error_code == ErrorCode::empty; });
  EXPECT_GE(made_up, 3);
  EXPECT_LE(made_up, 5);
  EXPECT_LT(position_error_m(body, results.sweeps.back().result.pose), 0.1);
}

TEST(TumblingOdometry, SweepsThatNobodyTakesAreDropped) {
  const ThrownBody body;
  TumblingOdometry::Params params = params_of(body);
  params.expert->waiting_sweeps_max = 4;
  TumblingOdometry odometry(params);
  const std::vector<ThrownBody::Sweep> sweeps = body.sweeps();
  std::size_t next = 0;
  for (const ImuSample& sample : body.imu()) {
    ASSERT_TRUE(odometry.add_imu(sample).ok());
    for (; next < sweeps.size() && sweeps[next].end_ns <= sample.time_ns; ++next)
      ASSERT_TRUE(odometry.add_sweep(sweeps[next].start_ns, sweeps[next].end_ns, sweeps[next].points).ok());
  }
  std::size_t left = 0;
  while (odometry.take()) ++left;
  EXPECT_EQ(left, 4u);
  EXPECT_GT(odometry.dropped_untaken_sweeps(), 20u);
}

TEST(TumblingOdometry, TroubleIsAValueAndChangesNothing) {
  const ThrownBody body;
  const std::vector<ImuSample> imu = body.imu();
  TumblingOdometry odometry(params_of(body)), untouched(params_of(body));
  ASSERT_TRUE(odometry.add_imu(imu[0]).ok());
  ASSERT_TRUE(untouched.add_imu(imu[0]).ok());
  ImuSample bad = imu[1];
  bad.specific_force_m_s2.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(odometry.add_imu(bad).error_code, ErrorCode::non_finite);
  EXPECT_EQ(odometry.add_imu(imu[0]).error_code, ErrorCode::time_order);
  const std::vector<LidarPoint> late(1, LidarPoint{.offset_ns = 200'000'000});
  EXPECT_EQ(odometry.add_sweep(0, kSweep_ns, late).error_code, ErrorCode::out_of_range);
  EXPECT_EQ(odometry.add_sweep(5, 4, {}).error_code, ErrorCode::time_order);
  EXPECT_EQ(odometry.add_sweep(0, 3'600'000'000'000, {}).error_code, ErrorCode::out_of_range);
  Answers a, b;
  feed_as_they_end(imu, body.sweeps(), 1, imu.size(), odometry, a);
  feed_as_they_end(imu, body.sweeps(), 1, imu.size(), untouched, b);
  ASSERT_FALSE(a.sweeps.empty());
  EXPECT_EQ(a.sweeps.back().result.pose.position_W_m, b.sweeps.back().result.pose.position_W_m);
  EXPECT_EQ(odometry.add_sweep(0, kSweep_ns, {}).error_code, ErrorCode::time_order);
}

TEST(TumblingOdometry, SweepsThatWaitAreBounded) {
  const ThrownBody body;
  TumblingOdometry::Params params = params_of(body);
  params.expert->waiting_sweeps_max = 3;
  TumblingOdometry odometry(params);
  const int most = 3 + 4;  // sweeps_max, and the sweeps within a lag of 0.2 s
  // before the first sample, a new sweep replaces the oldest sweep
  for (int k = -most - 2; k < 0; ++k) EXPECT_TRUE(odometry.add_sweep(k * kSweep_ns, (k + 1) * kSweep_ns, {}).ok());
  EXPECT_EQ(odometry.sweeps_before_first_imu(), 2u);
  ASSERT_TRUE(odometry.add_imu(body.imu().front()).ok());
  EXPECT_EQ(odometry.sweeps_before_first_imu(), static_cast<std::size_t>(most) + 2);
  for (int k = 0; k < most; ++k) EXPECT_TRUE(odometry.add_sweep(k * kSweep_ns, (k + 1) * kSweep_ns, {}).ok());
  const Status status = odometry.add_sweep(most * kSweep_ns, (most + 1) * kSweep_ns, {});
  EXPECT_EQ(status.error_code, ErrorCode::out_of_range);
  EXPECT_EQ(status.bound, double(most));
}

TEST(TumblingOdometry, RefusesParametersOutOfTheirBounds) {
  const auto refuses = [](const auto& change) {
    TumblingOdometry::Params params = params_of(ThrownBody());
    change(params);
    try {
      const TumblingOdometry odometry(params);
      return std::string();
    } catch (const InvalidParams& error) {
      return std::string(error.what());
    }
  };
  using Params = TumblingOdometry::Params;
  const auto names = [](const std::string& text, const char* field) { return text.find(field) != std::string::npos; };
  EXPECT_EQ(refuses([](Params&) {}), "");
  EXPECT_TRUE(names(refuses([](Params& p) { p.lever_arm_sigma_m = -1.0; }), "lever_arm_sigma_m"));
  EXPECT_TRUE(names(refuses([](Params& p) { p.imu.rate_hz = 0.0; }), "rate_hz"));
  EXPECT_TRUE(names(refuses([](Params& p) { p.lag_s = 100.0; }), "lag_s"));  // longer than the window of the rates
  EXPECT_TRUE(
      names(refuses([](Params& p) { p.expert->first_seconds_reprocessing.tracking_failure_s = -0.1; }), "lost_s"));
  EXPECT_TRUE(
      names(refuses([](Params& p) { p.expert->mapping.expert.matching.distance_m = 0.0; }), "match_distance_m"));
  // a missing lever arm is an error, but a lever arm of zero is accepted
  EXPECT_TRUE(names(refuses([](Params& p) { p.lever_arm_I_m = Params().lever_arm_I_m; }), "lever_arm_m"));
  EXPECT_EQ(refuses([](Params& p) { p.lever_arm_I_m.setZero(); }), "");
  EXPECT_TRUE(names(refuses([](Params& p) { p.imu.gyro_range_rad_s = 450.0; }), "gyro_range_rad_s"));
  const Eigen::Vector3d corner(0.5, 0.4, 0.2);
  EXPECT_EQ(refuses([&](Params& p) { p.own_body_L = {-corner, corner}; }), "");
  EXPECT_TRUE(names(refuses([&](Params& p) { p.own_body_L = {corner, -corner}; }), "own_body_L"));
}

}  // namespace
}  // namespace tumble
