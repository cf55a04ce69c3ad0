// SPDX-License-Identifier: BSD-3-Clause
// Tests of TumblingOdometry with the whole recording.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "thrown_body.hpp"
#include "thrown_params.hpp"
#include "tumble/mapping/detail/deskew.hpp"
#include "tumble/odometry/detail/mapping_passes.hpp"
#include "tumble/odometry/detail/waiting_input.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"

namespace tumble {
namespace {

using test::ThrownBody;

TumblingOdometry::Params whole_params(const ThrownBody& body) {
  TumblingOdometry::Params params = test::params_of(body);
  params.lag_s = TumblingOdometry::kWholeRecording;
  return params;
}

void record_all(const std::vector<ImuSample>& imu, const std::vector<ThrownBody::Sweep>& sweeps,
                TumblingOdometry& odometry) {
  for (const ImuSample& sample : imu) ASSERT_TRUE(odometry.add_imu(sample).ok());
  for (const ThrownBody::Sweep& sweep : sweeps)
    ASSERT_TRUE(odometry.add_sweep(sweep.start_ns, sweep.end_ns, sweep.points).ok());
}

std::vector<TumblingOdometry::Sweep> take_recorded(TumblingOdometry& odometry) {
  std::vector<TumblingOdometry::Sweep> out;
  while (std::optional<TumblingOdometry::Sweep> sweep = odometry.take()) out.push_back(std::move(*sweep));
  return out;
}

std::vector<TumblingOdometry::Sweep> estimate_recording(const ThrownBody& body, const std::vector<ImuSample>& imu,
                                                        TumblingOdometry& odometry) {
  record_all(imu, body.sweeps(), odometry);
  EXPECT_TRUE(odometry.finish().ok());
  return take_recorded(odometry);
}

double recorded_error_m(const ThrownBody& body, const PoseState& pose) {
  return (pose.position_W_m - body.T_WI(seconds(pose.time_ns)).translation()).norm();
}

// The body spins about a constant axis, so the specific force determines only the product of lever arm and squared
// rate. The standard deviation of the lever arm is therefore 5 mm. With 10 mm, the rate error is up to 2.0 rad/s, and
// the health falsely reports a wrong gyro.
TEST(TumblingRecording, EstimatesAThrowBeyondTheRail) {
  const ThrownBody body;
  TumblingOdometry::Params params = whole_params(body);
  params.lever_arm_sigma_m = 0.005;
  TumblingOdometry odometry(params);
  const std::vector<ImuSample> imu = body.imu();
  const auto sweeps = estimate_recording(body, imu, odometry);
  ASSERT_EQ(sweeps.size(), body.sweeps().size());
  for (const TumblingOdometry::Sweep& sweep : sweeps) {
    EXPECT_TRUE(sweep.status.ok()) << sweep.status.message();
    EXPECT_EQ(sweep.result.pose.time_ns, sweep.result.trajectory.back().time_ns);
  }
  // same bound as in the test with a lag, because the returns have no noise
  EXPECT_LT(recorded_error_m(body, sweeps.back().result.pose), 0.02);
  EXPECT_GT(odometry.mapper().map().size(), 1000u);
  EXPECT_TRUE(odometry.health().ok()) << odometry.health().worst_message();
  const WholeRecordingEstimate* const whole = odometry.whole_recording_result();
  ASSERT_NE(whole, nullptr);
  ASSERT_EQ(whole->rates.size(), imu.size());
  EXPECT_TRUE(whole->health.ok());
  EXPECT_TRUE(whole->suspected_error_covariance_rad2_s2.empty());
  EXPECT_GE(whole->mapped_recording.mapping_pass_count,
            2);  // the last pass starts from the calibration of the first pass
  EXPECT_TRUE(whole->mapped_recording.calibration_converged);
  EXPECT_EQ(odometry.body_imu_calibration().constants, whole->report.rate.calibration.constants);

  // rates of clipped samples are more accurate than the readings
  const double to_s = body.rest_s + body.push_s + body.flight_s;
  double of_readings = 0.0, of_rates = 0.0;
  for (std::size_t k = 0; k < imu.size(); ++k) {
    const AngularRateState& rate = whole->rates[k];
    const double t_s = seconds(rate.time_ns);
    if (rate.clipped_axes == 0 || t_s < body.rest_s + body.push_s || t_s > to_s) continue;
    const Eigen::Vector3d truth = body.w_WI_I_rad_s(t_s);
    of_readings = std::max(of_readings, (imu[k].angular_velocity_rad_s - truth).norm());
    of_rates = std::max(of_rates, (rate.w_WI_I_rad_s - truth).norm());
  }
  EXPECT_GT(of_readings, 3.0);
  EXPECT_LT(of_rates, 0.3 * of_readings);  // as in TumblingOdometry.RecoversTheRateInFlight
}

TEST(TumblingRecording, AnswersAfterFinishOnly) {
  const ThrownBody body;
  TumblingOdometry odometry(whole_params(body));
  const std::vector<ImuSample> imu = body.imu();
  record_all(imu, body.sweeps(), odometry);
  PoseState pose;
  EXPECT_EQ(odometry.newest(pose).error_code, ErrorCode::empty);
  EXPECT_FALSE(odometry.take());
  EXPECT_EQ(odometry.whole_recording_result(), nullptr);
  ASSERT_TRUE(odometry.finish().ok());
  EXPECT_FALSE(take_recorded(odometry).empty());
  ImuSample later = imu.back();
  later.time_ns += 10'000'000;
  EXPECT_EQ(odometry.add_imu(later).error_code, ErrorCode::out_of_range);
  EXPECT_EQ(odometry.add_sweep(later.time_ns, later.time_ns, {}).error_code, ErrorCode::out_of_range);
  odometry.reset();
  EXPECT_EQ(odometry.whole_recording_result(), nullptr);
  EXPECT_TRUE(odometry.add_imu(later).ok());
}

TEST(TumblingRecording, ALastSweepIsCutAtTheLastSample) {
  const ThrownBody body;
  const std::vector<ThrownBody::Sweep> sweeps = body.sweeps();
  const auto until = [&](double share) {
    const auto length_ns = double(sweeps.back().end_ns - sweeps.back().start_ns);
    const TimeNs end_ns = sweeps.back().start_ns + static_cast<TimeNs>(share * length_ns);
    std::vector<ImuSample> imu = body.imu();
    std::erase_if(imu, [&](const ImuSample& sample) { return sample.time_ns > end_ns; });
    return imu;
  };
  TumblingOdometry most(whole_params(body)), little(whole_params(body));
  EXPECT_EQ(estimate_recording(body, until(0.7), most).size(), sweeps.size());
  EXPECT_EQ(most.whole_recording_result()->mapped_recording.unfinished_sweeps, 0u);
  EXPECT_EQ(estimate_recording(body, until(0.3), little).size(), sweeps.size() - 1);
  EXPECT_EQ(little.whole_recording_result()->mapped_recording.unfinished_sweeps, 1u);
}

TEST(TumblingRecording, OneWrongItemCostsOneItem) {
  const ThrownBody body;
  const std::vector<ImuSample> clean = body.imu();
  TumblingOdometry reference(whole_params(body)), odometry(whole_params(body));
  const PoseState expected = estimate_recording(body, clean, reference).back().result.pose;
  std::size_t refused = 0;
  for (std::size_t k = 0; k < clean.size(); ++k) {
    ImuSample sample = clean[k];
    if (k == 50) sample.time_ns += 3'600'000'000'000;       // an hour ahead
    if (k == 60) sample.time_ns = clean[40].time_ns;        // out of order
    if (k == 70) sample.angular_velocity_rad_s.x() += 5.0;  // a wild reading at rest
    if (k == 80) sample.specific_force_m_s2.z() = std::nan("");
    refused += !odometry.add_imu(sample).ok();
  }
  for (const ThrownBody::Sweep& sweep : body.sweeps())
    ASSERT_TRUE(odometry.add_sweep(sweep.start_ns, sweep.end_ns, sweep.points).ok());
  ASSERT_TRUE(odometry.finish().ok());
  EXPECT_EQ(refused, 3u);
  EXPECT_EQ(odometry.rejected_readings(), 1u);
  EXPECT_EQ(odometry.whole_recording_result()->rates.size(), clean.size() - 4);
  const PoseState pose = take_recorded(odometry).back().result.pose;
  EXPECT_LT((pose.position_W_m - expected.position_W_m).norm(), 0.005);
}

TEST(TumblingRecording, FindsTheOdometerReadingThatALiveRunTakes) {
  constexpr TimeNs kMs = 1'000'000;
  WaitingReadings taken;
  for (TimeNs at = 20 * kMs; at < 1000 * kMs; at += 70 * kMs) {
    RelativePoseReading motion;
    motion.from_ns = at;
    motion.to_ns = at + 60 * kMs;  // some motions span two sweeps
    motion.covariance.setIdentity();
    ASSERT_TRUE(taken.add(motion, 0, 2000 * kMs).ok());
  }
  const WaitingReadings kept = taken;
  int found = 0;
  for (TimeNs from = 0; from < 1000 * kMs; from += 100 * kMs) {
    const auto expected = taken.take_readings_in(from, from + 100 * kMs), here = kept.find(from, from + 100 * kMs);
    ASSERT_EQ(here.has_value(), expected.has_value()) << from;
    if (!here) continue;
    ++found;
    EXPECT_EQ(reading_start_ns(*here), reading_start_ns(*expected));
  }
  EXPECT_GT(found, 2);
}

TEST(TumblingRecording, SavesItsResults) {
  const ThrownBody body;
  TumblingOdometry odometry(whole_params(body)), loaded(whole_params(body));
  record_all(body.imu(), body.sweeps(), odometry);
  ASSERT_TRUE(odometry.finish().ok());
  std::optional<PoseState> last;
  const Status status = loaded.load(odometry.save(), &last);
  ASSERT_TRUE(status.ok()) << status.message();
  EXPECT_EQ(loaded.body_imu_calibration().constants.lever_arm_m, odometry.body_imu_calibration().constants.lever_arm_m);
  EXPECT_EQ(loaded.mapper().lidar_calibration().T_IL.matrix(), odometry.mapper().lidar_calibration().T_IL.matrix());
  const auto sweeps = take_recorded(odometry);
  ASSERT_TRUE(last);
  EXPECT_LT((last->position_W_m - sweeps.back().result.pose.position_W_m).norm(), 0.05);
  // a later recording starts at the saved pose
  record_all(body.imu(), body.sweeps(), loaded);
  ASSERT_TRUE(loaded.finish().ok());
  EXPECT_LT((take_recorded(loaded).front().result.pose.position_W_m - last->position_W_m).norm(), 0.05);
}

TEST(TumblingRecording, ReportsAFrozenAxis) {
  const ThrownBody body;
  TumblingOdometry odometry(whole_params(body));
  std::vector<ImuSample> imu = body.imu();
  double noise = 1e-4;
  for (std::size_t k = 0; k < imu.size(); ++k) {  // readings of a working sensor never repeat
    imu[k].angular_velocity_rad_s += Eigen::Vector3d::Constant(noise = -noise) * double(k % 7);
    if (k > 130) imu[k].angular_velocity_rad_s.z() = 0.7;
  }
  record_all(imu, body.sweeps(), odometry);
  (void)odometry.finish();
  ASSERT_NE(odometry.whole_recording_result(), nullptr);
  const SensorHealth health = odometry.health();
  const auto& all = health.findings;
  const auto frozen = std::find_if(all.begin(), all.end(), [](const HealthFinding& finding) {
    return finding.kind == HealthFinding::Kind::frozen_axis;
  });
  ASSERT_NE(frozen, all.end());
  EXPECT_STREQ(frozen->axis, "gyro_z");
  EXPECT_EQ(frozen->since_ns, imu[131].time_ns);
  EXPECT_FALSE(odometry.health().ok());
  EXPECT_EQ(odometry.whole_recording_result()->suspected_error_covariance_rad2_s2.size(),
            odometry.whole_recording_result()->rates.size());
}

TEST(TumblingRecording, ARecordingWithoutSamplesIsAnError) {
  const ThrownBody body;
  TumblingOdometry odometry(whole_params(body));
  EXPECT_EQ(odometry.finish().error_code, ErrorCode::empty);
  EXPECT_EQ(odometry.whole_recording_result(), nullptr);
}

}  // namespace
}  // namespace tumble
