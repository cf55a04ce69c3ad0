// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <pthread.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "rolled_sphere.hpp"
#include "thrown_body.hpp"
#include "tumble/odometry/expert_params.hpp"
#include "tumble/tumble.hpp"

namespace tumble {
namespace {

// Documented limit of the odometry classes. Measured with GCC 12 -O3: 165.9 KiB (tumbling), 73.3 KiB (rolling). Other
// compilers and flags use other stack frames.
constexpr double kPromised_KiB = 256.0;

/// Of a thread whose stack is painted beforehand: how far below its own frame the call wrote at its deepest [KiB].
class PaintedStack {
 public:
  double reached_KiB(const std::function<void()>& call) {
    std::fill(stack_.begin(), stack_.end(), kPaint);
    call_ = &call;
    pthread_attr_t attributes;
    pthread_t thread;
    EXPECT_EQ(pthread_attr_init(&attributes), 0);
    EXPECT_EQ(pthread_attr_setstack(&attributes, stack_.data(), stack_.size()), 0);
    EXPECT_EQ(pthread_create(&thread, &attributes, &PaintedStack::run, this), 0);
    EXPECT_EQ(pthread_join(thread, nullptr), 0);
    EXPECT_EQ(pthread_attr_destroy(&attributes), 0);
    const auto deepest = std::find_if(stack_.begin(), stack_.end(), [](std::byte b) { return b != kPaint; });
    EXPECT_NE(deepest, stack_.begin()) << "it may have written below the stack";
    return double(from_ - &*deepest) / 1024.0;
  }

 private:
  static constexpr std::byte kPaint{0xA5};

  static void* run(void* me) {
    auto& self = *static_cast<PaintedStack*>(me);
    self.from_ = static_cast<std::byte*>(__builtin_frame_address(0));
    (*self.call_)();
    return nullptr;
  }

  std::vector<std::byte> stack_ = std::vector<std::byte>(std::size_t{4} << 20);
  const std::function<void()>* call_ = nullptr;
  const std::byte* from_ = nullptr;
};

class Stack : public testing::Test {
 protected:
  void SetUp() override {
#ifndef TUMBLE_BUILT_AS_RELEASED
    GTEST_SKIP() << "frames of another build are others";
#endif
  }
  void within(const char* what, const std::function<void()>& call) {
    const double reached = painted_.reached_KiB(call);
    RecordProperty(what, std::to_string(reached));
    EXPECT_LE(reached, kPromised_KiB) << what;
  }

  PaintedStack painted_;
};

TEST_F(Stack, NegativeControl) {
  const auto deep = [] {
    volatile std::byte frame[300 * 1024];
    frame[0] = std::byte{1};
    (void)frame[0];
  };
  EXPECT_GT(painted_.reached_KiB(deep), 300.0);
  EXPECT_LT(painted_.reached_KiB(deep), 304.0);
  EXPECT_LT(painted_.reached_KiB([] {}), 4.0);
}

void roll(RollingOdometry& odometry) {
  std::vector<std::vector<ImuSample>> readings;
  for (const Eigen::Vector3d& position : test::kPositions) readings.push_back(test::unit_at(position));
  std::vector<ImuSample> now(readings.size());
  for (std::size_t i = 0; i < readings[0].size(); ++i) {
    for (std::size_t k = 0; k < now.size(); ++k) {
      now[k] = readings[k][i];
      // impacts, and a rotation that is impossible for a rolling sphere, so that modes are uncertain
      if (i > 400 && i < 700 && i % 37 < 9)
        now[k].specific_force_m_s2 += Eigen::Vector3d(8.0, 3.0 * double(i % 4), -5.0);
      if (i > 550 && i < 800) now[k].angular_velocity_rad_s.x() += 0.4;
    }
    ASSERT_TRUE(odometry.add_imus(now).ok());
    (void)odometry.newest();
    if (i % 2 == 0) (void)odometry.take();
  }
}

TEST_F(Stack, OfARollingSphereLiveAndSmoothed) {
  for (const double lag_s : {0.0, 0.5}) {
    RollingOdometry::Params params = test::params_of(test::kPositions);
    params.lag_s = lag_s;
    std::unique_ptr<RollingOdometry> odometry;
    std::vector<std::byte> bytes;
    within("made", [&] { odometry = std::make_unique<RollingOdometry>(params); });
    within("samples", [&] { roll(*odometry); });
    within("saved", [&] { bytes = odometry->save(); });
    within("loaded", [&] { ASSERT_TRUE(odometry->load(bytes).ok()); });
    within("finished", [&] { odometry->finish(); });
    within("reset", [&] { odometry->reset(); });
  }
}

/// With `error_code` a segment of the IMU is missing, and sweeps of another scale follow, in which it finds no place:
/// sweeps that were rejected.
std::size_t tumble_over(const test::ThrownBody& body, bool error_code, TumblingOdometry& odometry) {
  std::vector<test::ThrownBody::Sweep> sweeps = body.sweeps();
  std::size_t next = 0, rejected = 0;
  for (const ImuSample& sample : body.imu()) {
    if (error_code && sample.time_ns > 1'300'000'000 && sample.time_ns < 1'700'000'000) continue;
    EXPECT_TRUE(odometry.add_imu(sample).ok());
    for (; next < sweeps.size() && sweeps[next].end_ns <= sample.time_ns; ++next) {
      if (error_code && next % 8 > 4) {
        for (LidarPoint& point : sweeps[next].points) point.position_L_m *= 1.7f;
      }
      RelativePoseReading motion{sweeps[next].start_ns, sweeps[next].end_ns, Eigen::Isometry3d::Identity(), {}};
      motion.covariance = 100.0 * Eigen::Matrix<double, 6, 6>::Identity();
      EXPECT_TRUE(odometry.add_relative_pose(motion).ok());
      (void)odometry.add_sweep(sweeps[next].start_ns, sweeps[next].end_ns, sweeps[next].points);
      PoseState pose;
      (void)odometry.newest(pose);
      while (const auto done = odometry.take()) rejected += done->result.verdict == SweepVerdict::rejected;
    }
  }
  return rejected;
}

TEST_F(Stack, OfATumblingBodyInTroubleAndWithASecondPass) {
  for (const bool error_code : {false, true}) {
    test::ThrownBody body;
    body.end_s = 4.2;
    TumblingOdometry::Params params;
    params.lever_arm_I_m = body.lever_arm_I_m;
    params.imu.rate_hz = body.imu_hz;
    if (!error_code) {  // it has something to put right
      params.lever_arm_I_m += Eigen::Vector3d(-0.006, -0.006, 0.006);
      params.T_IL.linear() = Eigen::AngleAxisd(0.015, Eigen::Vector3d(-1.0, -2.0, 2.0).normalized()).toRotationMatrix();
      params.expert->first_seconds_reprocessing.after_motion_s = 0.9;
    }
    std::unique_ptr<TumblingOdometry> odometry;
    std::vector<std::byte> bytes;
    within("made", [&] { odometry = std::make_unique<TumblingOdometry>(params); });
    std::size_t rejected = 0;
    within("samples and sweeps", [&] { rejected = tumble_over(body, error_code, *odometry); });
    EXPECT_TRUE(error_code || odometry->first_seconds_reprocessing_applied());
    within("saved", [&] { bytes = odometry->save(); });
    within("loaded", [&] { ASSERT_TRUE(odometry->load(bytes).ok()); });
    within("finished", [&] { odometry->finish(); });
    EXPECT_TRUE(!error_code || rejected > 0) << "negative control: nothing was in trouble";
  }
}

}  // namespace
}  // namespace tumble
