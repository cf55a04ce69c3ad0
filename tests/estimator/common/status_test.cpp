// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/common/status.hpp"

#include "tests/testing.hpp"
#include "tumble/common/detail/sample_check.hpp"
#include "tumble/common/types.hpp"

namespace tumble {
namespace {

TEST(Status, DefaultIsSuccess) {
  EXPECT_TRUE(Status{}.ok());
  EXPECT_EQ(Status{}.message(), "ok");
}

TEST(Status, MessageNamesFieldValueAndBound) {
  const Status status{ErrorCode::time_order, "time_ns", 5.0, 7.0};
  EXPECT_FALSE(status.ok());
  EXPECT_EQ(status.message(), "time_order: time_ns is 5; the bound is 7");
}

TEST(Status, MessageKeepsEveryDigitAndPrintsNaN) {
  EXPECT_EQ((Status{ErrorCode::gap, "dt_s", 0.1, 1e-7}).message(), "gap: dt_s is 0.1; the bound is 1e-07");
  EXPECT_EQ((Status{ErrorCode::time_order, "time_ns", 1753351234567890.0, 0.0}).message(),
            "time_order: time_ns is 1753351234567890; the bound is 0");
  EXPECT_EQ((Status{ErrorCode::non_finite, "x", std::nan(""), 0.0}).message(), "non_finite: x is nan; the bound is 0");
}

TEST(Status, EveryTroubleHasItsOwnName) {
  std::set<std::string> names;
  for (int i = 0; i <= static_cast<int>(ErrorCode::diverged); ++i) names.insert(to_string(static_cast<ErrorCode>(i)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(ErrorCode::diverged) + 1);
  EXPECT_EQ(names.count("unknown"), 0u);
}

TEST(RequireWithin, AcceptsTheBoundsAndNamesWhatIsOutside) {
  EXPECT_NO_THROW(require_in_interval("gain", 0.0, 0.0, 1.0));
  EXPECT_NO_THROW(require_in_interval("gain", 1.0, 0.0, 1.0));
  EXPECT_THROW(require_in_interval("gain", std::nan(""), 0.0, 1.0), InvalidParams);
  EXPECT_THROW(require_in_interval("gain", -1e-300, 0.0, 1.0), InvalidParams);
  try {
    require_in_interval("gain", 1.5, 0.0, 1.0);
    FAIL() << "1.5 was accepted";
  } catch (const InvalidParams& error) {
    EXPECT_STREQ(error.what(), "gain is 1.5; it must be within [0, 1]");
  }
}

TEST(CheckSample, NamesTheFieldThatIsNotFinite) {
  ImuSample sample;
  EXPECT_TRUE(check_sample(sample).ok());
  sample.specific_force_m_s2.z() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(check_sample(sample).error_code, ErrorCode::non_finite);
  EXPECT_STREQ(check_sample(sample).field, "specific_force_m_s2");
  EXPECT_TRUE(std::isinf(check_sample(sample).value));
  sample.angular_velocity_rad_s.y() = std::nan("");
  EXPECT_STREQ(check_sample(sample).field, "angular_velocity_rad_s");
  EXPECT_TRUE(std::isnan(check_sample(sample).value));
}

TEST(CheckSample, RefusesWhatNoSensorSays) {
  ImuSample sample;
  sample.angular_velocity_rad_s.y() = kReadingMax;
  sample.specific_force_m_s2.x() = -kReadingMax;
  EXPECT_TRUE(check_sample(sample).ok());
  sample.specific_force_m_s2.x() = std::nextafter(-kReadingMax, -2.0 * kReadingMax);
  EXPECT_EQ(check_sample(sample).error_code, ErrorCode::out_of_range);
  EXPECT_STREQ(check_sample(sample).field, "specific_force_m_s2");
  EXPECT_EQ(check_sample(sample).value, sample.specific_force_m_s2.x());
  EXPECT_EQ(check_sample(sample).bound, kReadingMax);
}

TEST(CheckSamples, ReportsTheFirstErrorOfASequence) {
  std::vector<ImuSample> samples(4);
  for (std::size_t k = 0; k < samples.size(); ++k) samples[k].time_ns = static_cast<TimeNs>(k) * 10'000'000;
  EXPECT_TRUE(check_samples(samples, 0.01).ok());
  EXPECT_TRUE(check_samples({}, 0.01).ok());
  EXPECT_EQ(check_samples(samples, 0.009).error_code, ErrorCode::gap);
  samples[3].angular_velocity_rad_s.z() = std::nan("");
  EXPECT_EQ(check_samples(samples, 0.01).error_code, ErrorCode::non_finite);
  samples[2].time_ns = samples[1].time_ns;  // earlier than the previous sample
  const Status stuck = check_samples(samples, 0.01);
  EXPECT_EQ(stuck.error_code, ErrorCode::time_order);
  EXPECT_EQ(stuck.value, 10'000'000.0);
}

TEST(CheckFollows, RefusesEqualFallingAndDistantStamps) {
  EXPECT_TRUE(check_stamp_order(11, 10, 1.0).ok());
  EXPECT_TRUE(check_stamp_order(1000000010, 10, 1.0).ok());
  const Status equal = check_stamp_order(10, 10, 1.0), falling = check_stamp_order(9, 10, 1.0);
  EXPECT_EQ(equal.error_code, ErrorCode::time_order);
  EXPECT_EQ(falling.error_code, ErrorCode::time_order);
  EXPECT_EQ(falling.value, 9.0);
  EXPECT_EQ(falling.bound, 10.0);
  const Status gap = check_stamp_order(2000000010, 10, 1.0);
  EXPECT_EQ(gap.error_code, ErrorCode::gap);
  EXPECT_DOUBLE_EQ(gap.value, 2.0);
  EXPECT_EQ(gap.bound, 1.0);
  // stamps whose difference exceeds a signed 64-bit integer
  constexpr TimeNs kFirst = std::numeric_limits<TimeNs>::min(), kLast = std::numeric_limits<TimeNs>::max();
  EXPECT_EQ(check_stamp_order(0, kFirst, 1.0).error_code, ErrorCode::gap);
  EXPECT_DOUBLE_EQ(check_stamp_order(kLast, kFirst, 1.0).value, 18446744073.709551615);
  EXPECT_EQ(check_stamp_order(kFirst, kLast, 1.0).error_code, ErrorCode::time_order);
  EXPECT_TRUE(check_stamp_order(kFirst + 1, kFirst, 1.0).ok());
}

}  // namespace
}  // namespace tumble
