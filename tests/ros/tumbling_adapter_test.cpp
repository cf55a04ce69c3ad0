// SPDX-License-Identifier: BSD-3-Clause
// The test checks that TumblingAdapter publishes the library's results bit for bit, for the base frame, also after a
// step of the clock.
#include "tumble_ros/tumbling_adapter.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

#include "cloud_message.hpp"
#include "estimator/tests/live_readings.hpp"
#include "estimator/tests/thrown_params.hpp"
#include "recorded_outputs.hpp"
#include "tests/testing.hpp"

namespace tumble {

namespace {

using ros::TumblingAdapter;
using test::RecordedOutputs;
using test::ThrownBody;

constexpr TimeNs kEpoch_ns = 1'732'700'000'000'000'000;

TumblingAdapter::Params adapter_params(const ThrownBody& body) {
  TumblingAdapter::Params params;
  params.odometry = test::params_of(body);
  return params;
}

/// Calls add_imu for each sample. Calls add_sweep for each sweep, `later_ns` after the sweep's last sample has arrived.
template <class AddImu, class AddSweep>
void play(const ThrownBody& body, TimeNs later_ns, AddImu add_imu, AddSweep add_sweep) {
  const auto sweeps = body.sweeps();
  auto sweep = sweeps.begin();
  for (ImuSample sample : test::noisy(body.imu(), body.rail_rad_s)) {
    sample.time_ns += later_ns;
    add_imu(sample);
    for (; sweep != sweeps.end() && sweep->end_ns + later_ns <= sample.time_ns; ++sweep)
      add_sweep(sweep->start_ns + later_ns, sweep->points);
  }
}

/// Clouds that start before `until_ns` may be rejected.
void play_to(TumblingAdapter& adapter, const ThrownBody& body, TimeNs later_ns, TimeNs until_ns = 0) {
  play(
      body, later_ns, [&](const ImuSample& sample) { adapter.on_imu(sample); },
      [&](TimeNs start_ns, const std::vector<LidarPoint>& points) {
        const test::CloudMessage cloud = test::ouster_cloud(points);
        const Status status = adapter.on_cloud(cloud.view(start_ns));
        EXPECT_TRUE(status.ok() || start_ns - later_ns < until_ns) << status.message();
      });
}

template <class A, class B>
bool same_bits(const A& a, const B& b) {
  return a.rows() == b.rows() && std::memcmp(a.data(), b.data(), sizeof(double) * std::size_t(a.size())) == 0;
}

TEST(TumblingAdapter, PublishesTheLibrarysResultsBitForBit) {
  const ThrownBody body;
  RecordedOutputs got;
  TumblingAdapter adapter(adapter_params(body), got);
  play_to(adapter, body, kEpoch_ns);
  adapter.finish();

  TumblingOdometry odometry(test::params_of(body));
  odometry.reset(Eigen::Isometry3d::Identity());
  std::vector<SweepResult> sweeps;
  std::vector<PoseState> newest;
  std::vector<AngularRateState> rates;
  const auto take = [&] {
    while (const auto sweep = odometry.take())
      if (!sweep->result.trajectory.empty()) sweeps.push_back(sweep->result);
  };
  play(
      body, kEpoch_ns,
      [&](const ImuSample& sample) {
        const auto before = odometry.newest_imu_time_ns();
        odometry.add_imu(sample);
        const auto& rate = odometry.newest_smoothed_rate();
        if (rate && (rates.empty() || rates.back().time_ns != rate->time_ns)) rates.push_back(*rate);
        take();
        PoseState pose;
        if (odometry.newest_imu_time_ns() != before && odometry.newest(pose).ok()) newest.push_back(pose);
      },
      [&](TimeNs start_ns, const std::vector<LidarPoint>& points) {
        // a sweep ends at its last point
        const auto last = std::max_element(points.begin(), points.end(),
                                           [](const auto& a, const auto& b) { return a.offset_ns < b.offset_ns; });
        odometry.add_sweep(start_ns, start_ns + last->offset_ns, points);
      });
  odometry.finish();
  take();

  ASSERT_GT(sweeps.size(), 20u);
  ASSERT_EQ(got.sweeps.size(), sweeps.size());
  for (std::size_t k = 0; k < sweeps.size(); ++k) {
    EXPECT_EQ(got.sweeps[k].stamp_ns, sweeps[k].pose.time_ns);
    EXPECT_TRUE(same_bits(Vector3d(got.sweeps[k].T_OB.translation()), sweeps[k].pose.position_W_m));
    EXPECT_TRUE(same_bits(got.sweeps[k].pose_covariance, sweeps[k].pose.covariance));
  }
  ASSERT_EQ(got.newest.size(), newest.size());
  for (std::size_t k = 0; k < newest.size(); ++k)
    EXPECT_TRUE(same_bits(Vector3d(got.newest[k].T_OB.translation()), newest[k].position_W_m));
  ASSERT_EQ(got.rates.size(), rates.size());
  for (std::size_t k = 0; k < rates.size(); ++k) {
    EXPECT_EQ(got.rates[k].rate.time_ns, rates[k].time_ns);
    EXPECT_TRUE(same_bits(got.rates[k].rate.w_WI_I_rad_s, rates[k].w_WI_I_rad_s));
    EXPECT_TRUE(same_bits(got.rates[k].rate.covariance_rad2_s2, rates[k].covariance_rad2_s2));
  }
  // every registered sweep whose points are available is also published deskewed
  EXPECT_EQ(got.deskewed.size(), got.sweeps.size());
  EXPECT_EQ(got.maps.size(), 1u);  // every 5 s
  EXPECT_NEAR(double(got.health.size()), body.end_s, 1.0);
  EXPECT_TRUE(got.health.back().second.ok) << got.health.back().second.message;
  EXPECT_FALSE(got.health.front().second.ok) << "no sweep yet";
}

TEST(TumblingAdapter, CloudsMayArriveSecondsBeforeTheImu) {
  const ThrownBody body;
  RecordedOutputs in_order, early;
  TumblingAdapter expected(adapter_params(body), in_order), adapter(adapter_params(body), early);
  play_to(expected, body, kEpoch_ns);
  const auto sweeps = body.sweeps();
  auto sweep = sweeps.begin();
  for (ImuSample sample : test::noisy(body.imu(), body.rail_rad_s)) {
    for (; sweep != sweeps.end() && sweep->end_ns <= sample.time_ns + 2'000'000'000; ++sweep) {
      const test::CloudMessage cloud = test::ouster_cloud(sweep->points);
      EXPECT_TRUE(adapter.on_cloud(cloud.view(sweep->start_ns + kEpoch_ns)).ok());
    }
    sample.time_ns += kEpoch_ns;
    adapter.on_imu(sample);
  }
  ASSERT_EQ(early.sweeps.size(), in_order.sweeps.size());
  for (std::size_t k = 0; k < early.sweeps.size(); ++k) {
    EXPECT_EQ(early.sweeps[k].stamp_ns, in_order.sweeps[k].stamp_ns);
    EXPECT_EQ(early.sweeps[k].T_OB.matrix(), in_order.sweeps[k].T_OB.matrix());
  }
  EXPECT_EQ(early.deskewed.size(), in_order.deskewed.size());
}

// The test checks that the velocity's covariance has the size of its error: the body rests, then flies at 2 m/s and
// more.
TEST(TumblingAdapter, TheTwistHasItsStatedAccuracy) {
  const ThrownBody body;
  RecordedOutputs got;
  TumblingAdapter adapter(adapter_params(body), got);
  play_to(adapter, body, 0);
  double nees = 0.0;
  for (const ros::Odometry& odometry : got.sweeps) {
    const double t_s = 1e-9 * double(odometry.stamp_ns), h_s = 1e-4;
    const Vector3d v_W = (body.T_WI(t_s + h_s).translation() - body.T_WI(t_s - h_s).translation()) / (2.0 * h_s);
    const Vector3d error = odometry.twist_B.head<3>() - body.T_WI(t_s).linear().transpose() * v_W;
    const Matrix3d covariance = odometry.twist_covariance.topLeftCorner<3, 3>();
    EXPECT_GT(covariance.diagonal().minCoeff(), 0.0);
    nees += error.dot(covariance.ldlt().solve(error)) / 3.0 / double(got.sweeps.size());
  }
  EXPECT_LT(nees, 4.0);    // the expected value is 1; the mean is over 31 sweeps of one run
  EXPECT_GT(nees, 0.003);  // measured 0.015; mounting and lever arm are exact, but stated within 1 cm and 0.6 degrees
}

TEST(TumblingAdapter, ALevelBaseStartsAtTheOrigin) {
  const ThrownBody body;
  TumblingAdapter::Params params = adapter_params(body);
  params.T_BI = Eigen::Translation3d(0.2, -0.1, 0.4) * Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ());
  params.T_BL = params.T_BI;
  RecordedOutputs got;
  TumblingAdapter adapter(params, got);
  play_to(adapter, body, 0);
  ASSERT_FALSE(got.sweeps.empty());
  // levelling is accurate to 1 mrad, and the IMU is 0.5 m from the base
  EXPECT_LT(got.sweeps.front().T_OB.translation().norm(), 2e-3);
  EXPECT_TRUE(got.sweeps.front().T_OB.linear().isIdentity(5e-3));
  // later poses of the base follow from the IMU's known motion, turned by the mounting
  const ros::Odometry& last = got.sweeps.back();
  const Isometry3d truth = params.T_BI * body.T_WI(1e-9 * double(last.stamp_ns)) * params.T_BI.inverse();
  EXPECT_LT((last.T_OB.translation() - truth.translation()).norm(), 0.1);
  EXPECT_LT((last.T_OB.linear() - truth.linear()).norm(), 0.05);
}

TEST(TumblingAdapter, ContinuesAfterTheClockStepsBack) {
  const ThrownBody body;
  RecordedOutputs got;
  TumblingAdapter adapter(adapter_params(body), got);
  play_to(adapter, body, kEpoch_ns);
  const Vector3d last = got.sweeps.back().T_OB.translation();
  play_to(adapter, body, 0, 300'000'000);  // the bag is played again, with another clock; the run restarts after 0.2 s
  EXPECT_EQ(adapter.odometry().restart_count(), 1u);
  const auto again = std::find_if(got.sweeps.begin(), got.sweeps.end(),
                                  [](const ros::Odometry& each) { return each.stamp_ns < kEpoch_ns; });
  ASSERT_GT(got.sweeps.end() - again, 20);
  EXPECT_LT((again->T_OB.translation() - last).norm(), 0.2) << "the run continues at its newest pose";
  for (auto each = again + 1; each != got.sweeps.end(); ++each) EXPECT_GT(each->stamp_ns, (each - 1)->stamp_ns);
  EXPECT_LT(got.rates.back().rate.time_ns, 10'000'000'000);
  EXPECT_LT(got.deskewed.back().stamp_ns, 10'000'000'000);
}

TEST(TumblingAdapter, ResetStartsAtTheGivenPose) {
  const ThrownBody body;
  RecordedOutputs got;
  TumblingAdapter::Params params = adapter_params(body);
  params.T_BI = params.T_BL = Isometry3d(Eigen::Translation3d(0.0, 0.0, 0.3));
  TumblingAdapter adapter(params, got);
  const Isometry3d T_OB = Eigen::Translation3d(10.0, 20.0, 1.0) * Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(adapter.reset(ros::StartPose{T_OB}).ok());
  play_to(adapter, body, 0);
  ASSERT_FALSE(got.sweeps.empty());
  EXPECT_LT((got.sweeps.front().T_OB.translation() - T_OB.translation()).norm(), 2e-3);
  EXPECT_LT((got.sweeps.front().T_OB.linear() - T_OB.linear()).norm(), 5e-3);
}

TEST(TumblingAdapter, LocalisesInASavedMap) {
  const ThrownBody body;
  RecordedOutputs first, second;
  TumblingAdapter mapped(adapter_params(body), first);
  const Isometry3d T_OB = Eigen::Translation3d(3.0, -2.0, 0.0) * Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(mapped.reset(ros::StartPose{T_OB}).ok());
  play_to(mapped, body, 0);
  const std::string bytes = mapped.map_file("room.tumblemap");
  EXPECT_TRUE(mapped.map_file("room.ply").starts_with("ply"));

  TumblingAdapter adapter(adapter_params(body), second);
  EXPECT_FALSE(adapter.load_map(std::as_bytes(std::span("ply"))).ok());
  ASSERT_TRUE(adapter.load_map(std::as_bytes(std::span(bytes))).ok());
  EXPECT_FALSE(adapter.odometry().mapper().check_localised().ok());
  const Isometry3d near = Eigen::Translation3d(0.3, 0.2, 0.0) * T_OB;
  EXPECT_TRUE(adapter.reset(ros::StartPose{near, 0.3, 0.1}).ok());
  play_to(adapter, body, 0);
  EXPECT_TRUE(adapter.odometry().mapper().check_localised().ok());
  EXPECT_LT((second.sweeps.back().T_OB.translation() - first.sweeps.back().T_OB.translation()).norm(), 0.15)
      << "both runs end at the same pose of one map";
}

TEST(TumblingAdapter, PublishesThePoseInTheFrameOfPositions) {
  const ThrownBody body;
  TumblingAdapter::Params params = adapter_params(body);
  params.T_BI = params.T_BL = Isometry3d(Eigen::Translation3d(0.1, 0.0, 0.3));
  params.position_arm_B_m = {0.0, 0.2, 0.5};
  RecordedOutputs got;
  TumblingAdapter adapter(params, got);
  const Isometry3d T_PW = Eigen::Translation3d(10.0, 20.0, 1.0) * Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ());
  play(
      body, 0,
      [&](const ImuSample& sample) {
        adapter.on_imu(sample);
        if (sample.time_ns < 100'000'000) return;
        const Isometry3d T_WB = body.T_WI(1e-9 * double(sample.time_ns)) * params.T_BI.inverse();
        const Vector3d antenna_m = T_PW * T_WB * params.position_arm_B_m;
        EXPECT_TRUE(adapter.on_position(sample.time_ns, antenna_m, 1e-4 * Eigen::Matrix3d::Identity()).ok());
      },
      [&](TimeNs start_ns, const std::vector<LidarPoint>& points) {
        EXPECT_TRUE(adapter.on_cloud(test::ouster_cloud(points).view(start_ns)).ok());
      });
  ASSERT_FALSE(got.in_position_frame.empty());
  const ros::Odometry& last = got.in_position_frame.back();
  const Isometry3d T_PB = T_PW * body.T_WI(1e-9 * double(last.stamp_ns)) * params.T_BI.inverse();
  EXPECT_LT((last.T_OB.translation() - T_PB.translation()).norm(), 0.1);
  EXPECT_LT((last.T_OB.linear() - T_PB.linear()).norm(), 0.1);
}

TEST(TumblingAdapter, ReadsLivoxMessages) {
  const ThrownBody body;
  RecordedOutputs clouds, livox;
  TumblingAdapter expected(adapter_params(body), clouds), adapter(adapter_params(body), livox);
  play_to(expected, body, 0);
  play(
      body, 0, [&](const ImuSample& sample) { adapter.on_imu(sample); },
      [&](TimeNs start_ns, const std::vector<LidarPoint>& points) {
        EXPECT_TRUE(adapter.on_livox(test::livox_cdr(start_ns, "livox", points)).ok());
      });
  ASSERT_EQ(livox.sweeps.size(), clouds.sweeps.size());
  for (std::size_t k = 0; k < livox.sweeps.size(); ++k)
    EXPECT_EQ(livox.sweeps[k].T_OB.matrix(), clouds.sweeps[k].T_OB.matrix());
}

TEST(TumblingAdapter, ReportsRejectedMessages) {
  const ThrownBody body;
  RecordedOutputs got;
  TumblingAdapter adapter(adapter_params(body), got);
  ImuSample bad;
  bad.angular_velocity_rad_s.x() = std::nan("");
  EXPECT_EQ(adapter.on_imu(bad).error_code, ErrorCode::non_finite);
  EXPECT_EQ(adapter.on_cloud(ros::PointCloudView{}).error_code, ErrorCode::empty);
  ImuSample fine;
  fine.time_ns = 2'000'000'000;
  fine.specific_force_m_s2.z() = 9.8;
  adapter.on_imu(fine);
  const auto& values = got.health.back().second.values;
  const auto value = [&](const std::string& key) {
    const auto found = std::find_if(values.begin(), values.end(), [&](const auto& each) { return each.first == key; });
    return found == values.end() ? std::string("missing") : found->second;
  };
  EXPECT_EQ(value("imu messages rejected"), "1");
  EXPECT_EQ(value("imu messages"), "2");
  EXPECT_EQ(value("clouds messages rejected"), "1");
  EXPECT_NE(value("clouds last error").find("points"), std::string::npos);
}

TEST(TumblingAdapter, SkipsWhatNobodyReads) {
  const ThrownBody body;
  RecordedOutputs got;
  got.wanted = false;
  TumblingAdapter adapter(adapter_params(body), got);
  play_to(adapter, body, 0);
  EXPECT_TRUE(got.newest.empty() && got.deskewed.empty() && got.maps.empty());
  EXPECT_GT(got.sweeps.size(), 20u);
}

}  // namespace

}  // namespace tumble
