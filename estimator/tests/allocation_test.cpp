// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "rolled_sphere.hpp"
#include "thrown_body.hpp"
#include "tumble/odometry/expert_params.hpp"
#include "tumble/tumble.hpp"

// Every allocation of this program is counted; not inlined, so that the compiler does not take the pair for mismatched.
namespace {
std::atomic<std::size_t> g_allocations{0};
}

[[gnu::noinline]] void* operator new(std::size_t size) {
  ++g_allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {  // std::stable_sort uses it
  try {
    return operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace tumble {
namespace {

TEST(Allocation, NoneForASampleOfATumblingBodyOnceItHasBegun) {
  const test::ThrownBody body;
  TumblingOdometry::Params params;
  params.lever_arm_I_m = body.lever_arm_I_m;
  TumblingOdometry odometry(params);
  const std::vector<ImuSample> imu = body.imu();
  const std::vector<test::ThrownBody::Sweep> sweeps = body.sweeps();
  std::size_t next = 0, without_a_sweep = 0, in_all = 0;
  for (const ImuSample& sample : imu) {
    const std::size_t before = g_allocations;
    ASSERT_TRUE(odometry.add_imu(sample).ok());
    const std::size_t made = g_allocations - before;
    in_all += made;
    if (!odometry.take()) {
      // the lag has filled, and the mapper's memory of samples has the size of a sweep
      if (sample.time_ns > 600'000'000) without_a_sweep += made;
    }
    while (next < sweeps.size() && sweeps[next].end_ns <= sample.time_ns) {
      ASSERT_TRUE(odometry.add_sweep(sweeps[next].start_ns, sweeps[next].end_ns, sweeps[next].points).ok());
      ++next;
    }
  }
  EXPECT_EQ(without_a_sweep, 0u);
  EXPECT_GT(in_all, 0u) << "negative control: the counter counts";
}

TEST(Allocation, NoneForASampleAfterTheSecondPassTookOver) {
  test::ThrownBody body;
  body.end_s = 4.2;  // it lies long enough for the second pass to catch up
  TumblingOdometry::Params params;
  params.lever_arm_I_m = body.lever_arm_I_m + Eigen::Vector3d(-0.006, 0.006, -0.006);  // it has something to put right
  params.T_IL.linear() = Eigen::AngleAxisd(0.015, Eigen::Vector3d(-1.0, 2.0, -2.0).normalized()).toRotationMatrix();
  params.imu.rate_hz = body.imu_hz;
  params.expert->first_seconds_reprocessing.after_motion_s = 0.9;
  TumblingOdometry odometry(params);
  const std::vector<test::ThrownBody::Sweep> sweeps = body.sweeps();
  std::size_t next = 0, samples = 0, made = 0;
  for (const ImuSample& sample : body.imu()) {
    const bool taken_over = odometry.first_seconds_reprocessing_applied();
    const std::size_t before = g_allocations;
    ASSERT_TRUE(odometry.add_imu(sample).ok());
    const std::size_t by_it = g_allocations - before;
    if (!odometry.take() && taken_over) {
      ++samples;
      made += by_it;
    }
    while (next < sweeps.size() && sweeps[next].end_ns <= sample.time_ns) {
      ASSERT_TRUE(odometry.add_sweep(sweeps[next].start_ns, sweeps[next].end_ns, sweeps[next].points).ok());
      ++next;
    }
  }
  ASSERT_TRUE(odometry.first_seconds_reprocessing_applied());
  EXPECT_GT(samples, 10u) << "it took over while samples came";
  EXPECT_EQ(made, 0u);
}

TEST(Allocation, NoneForASampleOfARollingSphereOnceItHasBegun) {
  RollingOdometry::Params params = test::params_of({test::kPositions[0]});
  params.lag_s = 0.0;
  RollingOdometry odometry(params);
  std::size_t later = 0, in_all = 0;
  for (const ImuSample& sample : test::unit_at(test::kPositions[0])) {
    const std::size_t before = g_allocations;
    ASSERT_TRUE(odometry.add_imu(sample).ok());
    while (odometry.take()) continue;
    in_all += g_allocations - before;
    if (sample.time_ns > 100'000'000) later += g_allocations - before;
  }
  EXPECT_EQ(later, 0u);
  EXPECT_GT(in_all, 0u) << "negative control: the counter counts";
}

}  // namespace
}  // namespace tumble
