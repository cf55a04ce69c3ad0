// SPDX-License-Identifier: BSD-3-Clause
// Tests of position readings: the frame in closed form, outliers, the stated accuracy, and the drift bounded by
// positions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "odometry/position_alignment.hpp"
#include "thrown_body.hpp"
#include "thrown_params.hpp"
#include "tumble/common/types.hpp"

namespace tumble {
namespace position_readings {

using test::ThrownBody;

constexpr TimeNs kSweep_ns = 100'000'000;
const Eigen::Vector3d kArm_I_m(0.3, -0.2, 0.5);
const Eigen::Isometry3d kT_PW =
    Eigen::Translation3d(40.0, -25.0, 3.0) * Eigen::Isometry3d(Eigen::AngleAxisd(2.1, Eigen::Vector3d::UnitZ()));

/// Returns the pose of a robot that moves on a circle of 10 m at 1 m/s and turns about all axes.
PoseState truth(double t_s) {
  PoseState out;
  out.time_ns = static_cast<TimeNs>(std::llround(1e9 * t_s));
  out.position_W_m = {10.0 * std::sin(0.1 * t_s), 10.0 - 10.0 * std::cos(0.1 * t_s), 0.2 * std::sin(0.3 * t_s)};
  out.orientation_W = so3::exp({0.5 * std::sin(t_s), 0.3 * std::sin(0.7 * t_s), 0.1 * t_s});
  return out;
}

using Drift = std::function<PoseState(const PoseState&)>;
PoseState no_drift(const PoseState& pose) {
  return pose;
}

SweepResult report_of(int sweep, const Drift& drift) {
  SweepResult out;
  for (int k = 0; k <= 10; ++k)
    out.trajectory.push_back(drift(truth(1e-9 * double(sweep * kSweep_ns) + 0.01 * double(k))));
  out.pose = out.trajectory.back();
  return out;
}

/// Returns a reading of the position at the middle of a sweep, in P.
PositionReading reading_of(int sweep, double sigma_m, std::mt19937& random) {
  std::normal_distribution<double> noise(0.0, 1.0);
  const PoseState pose = truth(1e-9 * double(sweep * kSweep_ns) + 0.05);
  PositionReading out{.time_ns = pose.time_ns, .antenna_lever_arm_I_m = kArm_I_m};
  out.antenna_position_P_m = kT_PW * (pose.position_W_m + pose.orientation_W * kArm_I_m);
  for (double& axis : out.antenna_position_P_m) axis += sigma_m * noise(random);
  out.covariance_m2 = std::max(sigma_m * sigma_m, 1e-6) * Eigen::Matrix3d::Identity();
  return out;
}

Status add(PositionAlignment& alignment, const PositionReading& reading) {
  return alignment.add(reading, std::numeric_limits<TimeNs>::min(), std::numeric_limits<TimeNs>::max(),
                       PositionAlignment::kReadingsMax);
}

TEST(Positions, DetermineTheFrameInClosedForm) {
  std::mt19937 random(1);
  PositionAlignment alignment;
  for (int sweep = 0; sweep < 200; ++sweep) {
    ASSERT_TRUE(add(alignment, reading_of(sweep, 0.0, random)).ok());
    alignment.add_sweep(report_of(sweep, no_drift));
    EXPECT_TRUE(sweep >= 2 || !alignment.position_frame()) << "the heading is unknown";
  }
  ASSERT_TRUE(alignment.position_frame());
  EXPECT_TRUE(alignment.position_frame()->T_PW.isApprox(kT_PW, 1e-5));  // linear interpolation over 10 ms
  const PoseState pose = truth(20.0), in_P = alignment.position_frame()->transform(pose);
  EXPECT_LT((in_P.position_W_m - kT_PW * pose.position_W_m).norm(), 1e-3);
  EXPECT_LT(in_P.orientation_W.angularDistance(Eigen::Quaterniond(kT_PW.linear()) * pose.orientation_W), 1e-4);
}

TEST(Positions, UpToAFifthMayBeWrong) {
  for (const int every : {7, 2}) {
    std::mt19937 random(2);
    PositionAlignment alignment;
    for (int sweep = 0; sweep < 200; ++sweep) {
      PositionReading reading = reading_of(sweep, 0.05, random);
      if (sweep % every == 0)
        reading.antenna_position_P_m += 10.0 * Eigen::Vector3d(std::sin(sweep), std::cos(sweep), 0.0);
      ASSERT_TRUE(add(alignment, reading).ok());
      alignment.add_sweep(report_of(sweep, no_drift));
    }
    if (every == 2) {
      EXPECT_FALSE(alignment.position_frame()) << "negative control: half of the readings are wrong";
    } else {
      ASSERT_TRUE(alignment.position_frame());
      EXPECT_LT(
          (alignment.position_frame()->transform(truth(20.0)).position_W_m - kT_PW * truth(20.0).position_W_m).norm(),
          0.1);
    }
  }
}

TEST(Positions, TheFrameHasItsStatedAccuracy) {
  double nees = 0.0;
  constexpr int kRuns = 200;
  for (int run = 0; run < kRuns; ++run) {
    std::mt19937 random(static_cast<unsigned>(run));
    PositionAlignment alignment;
    for (int sweep = 0; sweep < 200; ++sweep) {
      if (sweep % 10 == 0) {
        ASSERT_TRUE(add(alignment, reading_of(sweep, 0.5, random)).ok());
      }
      alignment.add_sweep(report_of(sweep, no_drift));
    }
    ASSERT_TRUE(alignment.position_frame());
    const PoseState in_P = alignment.position_frame()->transform(truth(20.0));
    const Eigen::Vector3d error_m = in_P.position_W_m - kT_PW * truth(20.0).position_W_m;
    nees += error_m.dot(in_P.covariance.topLeftCorner<3, 3>().inverse() * error_m) / 3.0 / kRuns;
  }
  EXPECT_NEAR(nees, 1.0, 0.25);  // the mean of 600 squares has a standard deviation of 0.06; the poses have no drift
}

// The heading of the poses drifts by 0.1 degrees per metre, and their scale is wrong by 1 %.
TEST(Positions, BoundTheDrift) {
  const auto drift = [](const PoseState& pose) {
    PoseState out = pose;
    const double t_s = seconds(pose.time_ns);  // equals the path in metres
    const Eigen::Quaterniond turn = so3::exp({0.0, 0.0, 0.0017 * t_s});
    out.position_W_m = turn * (1.01 * pose.position_W_m) + Eigen::Vector3d(0.01 * t_s, 0.0, 0.005 * t_s);
    out.orientation_W = turn * pose.orientation_W;
    return out;
  };
  std::mt19937 random(3);
  PositionAlignment alignment;
  double worst_m = 0.0, sum_m2 = 0.0, drift_m = 0.0;
  int count = 0;
  Eigen::Isometry3d first = Eigen::Isometry3d::Identity();
  for (int sweep = 0; sweep < 6000; ++sweep) {
    if (sweep % 10 == 0) {
      ASSERT_TRUE(add(alignment, reading_of(sweep, 0.5, random)).ok());
    }
    const SweepResult report = report_of(sweep, drift);
    alignment.add_sweep(report);
    if (sweep == 300) first = alignment.position_frame().value().T_PW;
    if (sweep < 300) continue;
    ASSERT_TRUE(alignment.position_frame()) << sweep;
    const Eigen::Vector3d p_PI_m = kT_PW * truth(seconds(report.pose.time_ns)).position_W_m;
    const double error_m = (alignment.position_frame()->transform(report.pose).position_W_m - p_PI_m).norm();
    worst_m = std::max(worst_m, error_m);
    sum_m2 += error_m * error_m;
    ++count;
    drift_m = std::max(drift_m, (first * report.pose.position_W_m - p_PI_m).norm());
  }
  EXPECT_GT(drift_m, 10.0) << "negative control: the frame of the first 30 s, kept";
  EXPECT_LT(worst_m, 1.5);                                     // three standard deviations of one axis of a reading
  EXPECT_LT(std::sqrt(sum_m2 / count), 0.5 * std::sqrt(3.0));  // the error of one reading
}

// For all lags, the odometry estimates the frame, and the poses equal the poses without position readings.
TEST(Positions, DoNotChangeThePosesOfAnOdometry) {
  const ThrownBody body;
  const std::vector<ThrownBody::Sweep> sweeps = body.sweeps();
  const std::vector<ImuSample> imu = body.imu();
  for (const double lag_s : {0.0, 0.2, TumblingOdometry::kWholeRecording}) {
    TumblingOdometry::Params params = test::params_of(body);
    params.lag_s = lag_s;
    TumblingOdometry plain(params), with(params);
    std::vector<TumblingOdometry::Sweep> of_plain, of_with;
    const auto run = [&](TumblingOdometry& odometry, bool positions, std::vector<TumblingOdometry::Sweep>& out) {
      auto sweep = sweeps.begin();
      for (const ImuSample& sample : imu) {
        ASSERT_TRUE(odometry.add_imu(sample).ok());
        for (; sweep != sweeps.end() && sweep->end_ns <= sample.time_ns; ++sweep) {
          const Eigen::Isometry3d T_WI = body.T_WI(seconds(sweep->end_ns));
          PositionReading reading{sweep->end_ns, kT_PW * T_WI * kArm_I_m, 1e-4 * Eigen::Matrix3d::Identity(), kArm_I_m};
          ASSERT_TRUE(!positions || odometry.add_frame_alignment_position(reading).ok());
          ASSERT_TRUE(odometry.add_sweep(sweep->start_ns, sweep->end_ns, sweep->points).ok());
        }
        while (auto done = odometry.take()) out.push_back(std::move(*done));
      }
      ASSERT_TRUE(odometry.finish().ok());
      while (auto done = odometry.take()) out.push_back(std::move(*done));
    };
    run(plain, false, of_plain);
    run(with, true, of_with);
    ASSERT_EQ(of_plain.size(), of_with.size());
    for (std::size_t k = 0; k < of_plain.size(); ++k) {
      EXPECT_EQ(of_plain[k].result.pose.position_W_m, of_with[k].result.pose.position_W_m);
      EXPECT_EQ(of_plain[k].result.pose.covariance, of_with[k].result.pose.covariance);
      EXPECT_FALSE(of_plain[k].position_frame);
    }
    ASSERT_TRUE(of_with.back().position_frame) << lag_s;
    const PoseState end = of_with.back().position_frame->transform(of_with.back().result.pose);
    EXPECT_LT((end.position_W_m - kT_PW * body.T_WI(seconds(end.time_ns)).translation()).norm(), 0.05) << lag_s;
    EXPECT_EQ(with.position_frame().has_value(), lag_s < TumblingOdometry::kWholeRecording);
  }
}

TEST(Positions, WrongReadingsAreRejected) {
  const ThrownBody body;
  TumblingOdometry odometry(test::params_of(body));
  PositionReading fine{0, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()};
  EXPECT_EQ(odometry.add_frame_alignment_position(fine).error_code, ErrorCode::empty) << "no sample yet";
  const std::vector<ImuSample> imu = body.imu();
  for (std::size_t k = 0; k < 20; ++k) ASSERT_TRUE(odometry.add_imu(imu[k]).ok());
  EXPECT_EQ(odometry.add_frame_alignment_position(fine).error_code, ErrorCode::time_order) << "before the first sample";
  fine.time_ns = imu[19].time_ns;
  EXPECT_TRUE(odometry.add_frame_alignment_position(fine).ok());
  PositionReading bad = fine;
  bad.time_ns += 1'100'000'000;
  EXPECT_EQ(odometry.add_frame_alignment_position(bad).error_code, ErrorCode::out_of_range);
  bad = fine;
  bad.antenna_position_P_m.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(odometry.add_frame_alignment_position(bad).error_code, ErrorCode::non_finite);
  bad = fine;
  bad.covariance_m2(2, 2) = 0.0;
  EXPECT_EQ(odometry.add_frame_alignment_position(bad).error_code, ErrorCode::out_of_range);
  bad = fine;
  bad.covariance_m2(0, 1) = 0.5;
  EXPECT_EQ(odometry.add_frame_alignment_position(bad).error_code, ErrorCode::out_of_range) << "not symmetric";
  for (std::size_t k = 1; k < PositionAlignment::kReadingsMax; ++k)
    ASSERT_TRUE(odometry.add_frame_alignment_position(fine).ok());
  EXPECT_EQ(odometry.add_frame_alignment_position(fine).error_code, ErrorCode::out_of_range) << "too many";
}

}  // namespace position_readings
}  // namespace tumble
