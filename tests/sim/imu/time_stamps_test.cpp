// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/time_stamps.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sim/imu/imu_parameters.hpp"

namespace tumble::sim {
namespace {

constexpr std::int64_t kPeriod_ns = 10'000'000;

TimeStamps stamps(const std::map<std::string, double>& given, std::uint64_t seed = 1) {
  Values values = resolve("imu", {}, imu_parameters());
  for (const auto& [name, value] : given) values.set(name, value);
  return {values, "sensors.imu", kPeriod_ns, Stream(seed, "test")};
}

TEST(TimeStamps, OffIsTheEndOfTheWindow) {
  TimeStamps exact = stamps({});
  for (std::int64_t k = 1; k < 100; ++k) ASSERT_EQ(exact.stamp(k * kPeriod_ns), k * kPeriod_ns);
}

TEST(TimeStamps, OffsetIsConstant) {
  TimeStamps late = stamps({{"time_offset_s", -0.004}});
  EXPECT_EQ(late.stamp(kPeriod_ns), 6'000'000);
}

TEST(TimeStamps, JitterHasItsSizeAndStampsRise) {
  TimeStamps jittering = stamps({{"time_jitter_s", 0.0016}});
  double sum = 0.0;
  std::int64_t before = 0;
  constexpr int kCount = 20000;
  for (std::int64_t k = 1; k <= kCount; ++k) {
    const std::int64_t stamp = jittering.stamp(k * kPeriod_ns).value();
    ASSERT_GT(stamp, before);
    before = stamp;
    const double error_s = static_cast<double>(stamp - k * kPeriod_ns) * 1e-9;
    ASSERT_LE(std::abs(error_s), 3 * 0.0016 + 1e-9);
    sum += error_s * error_s;
  }
  // the limit of three standard deviations reduces it by 0.7 %; 5 standard errors are 2.5 %
  EXPECT_NEAR(std::sqrt(sum / kCount), 0.0016, 0.032 * 0.0016);
}

TEST(TimeStamps, LossesHaveTheirShareAndLength) {
  TimeStamps lossy = stamps({{"dropout_share", 0.1}, {"dropout_mean_samples", 5.0}});
  int lost = 0, runs = 0;
  bool before = false;
  constexpr int kCount = 200000;
  for (std::int64_t k = 1; k <= kCount; ++k) {
    const bool now = !lossy.stamp(k * kPeriod_ns);
    lost += now ? 1 : 0;
    runs += now && !before ? 1 : 0;
    before = now;
  }
  // 4000 runs of geometric length: 5 standard errors of their mean are 7 %, of the share 10 %
  EXPECT_NEAR(static_cast<double>(lost) / kCount, 0.1, 0.01);
  EXPECT_NEAR(static_cast<double>(lost) / runs, 5.0, 0.35);
}

TEST(TimeStamps, RefusesAJitterThatTurnsTimeBack) {
  try {
    stamps({{"time_jitter_s", 0.002}});
    FAIL() << "2 ms of jitter at 10 ms were accepted";
  } catch (const InvalidSituation& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("sensors.imu.time_jitter_s is 0.002 s; it must be below a sixth"));
  }
}

}  // namespace
}  // namespace tumble::sim
