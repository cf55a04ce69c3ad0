// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/common/sample_clock.hpp"

#include "tests/testing.hpp"

namespace tumble {
namespace {

constexpr TimeNs kStart_ns = 1'700'000'000'000'000'000;  // ns since 1970, which a double cannot represent exactly

/// Returns sample times, some of which are missing.
std::vector<TimeNs> regular(std::size_t count, double period_ns, double lost_share = 0.0) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform;
  std::vector<TimeNs> out;
  for (std::size_t number = 0; out.size() < count; ++number) {
    if (uniform(random) < lost_share) continue;
    out.push_back(kStart_ns + std::llround(static_cast<double>(number) * period_ns));
  }
  return out;
}

/// Returns stamps with random errors within three deviations.
std::vector<TimeNs> jittered(std::vector<TimeNs> times_ns, double jitter_ns) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  for (TimeNs& time_ns : times_ns) time_ns += std::llround(jitter_ns * std::clamp(normal(random), -3.0, 3.0));
  return times_ns;
}

std::vector<TimeNs> times_of(std::vector<TimeNs> stamps_ns, const SampleClock::Params& params = {}) {
  double corrected_jitter_s = 0.0;
  EXPECT_TRUE(correct_stamps(SampleClock(params), stamps_ns, corrected_jitter_s).ok());
  return stamps_ns;
}

/// Returns the rms difference from sample `first` on, without its mean, because a constant delay is an offset.
double spread_ns(const std::vector<TimeNs>& found, const std::vector<TimeNs>& expected, std::size_t first) {
  double sum = 0.0, squares = 0.0;
  for (std::size_t k = first; k < found.size(); ++k) {
    const auto difference = static_cast<double>(found[k] - expected[k]);
    sum += difference;
    squares += difference * difference;
  }
  const auto count = static_cast<double>(found.size() - first);
  return std::sqrt(squares / count - sum / count * sum / count);
}

double largest_ns(const std::vector<TimeNs>& found, const std::vector<TimeNs>& expected) {
  double largest = 0.0;
  for (std::size_t k = 0; k < found.size(); ++k)
    largest = std::max(largest, std::abs(static_cast<double>(found[k] - expected[k])));
  return largest;
}

bool rise(const std::vector<TimeNs>& times_ns) {
  return std::adjacent_find(times_ns.begin(), times_ns.end(), [](TimeNs a, TimeNs b) { return a >= b; }) ==
         times_ns.end();
}

TEST(SampleClock, StampsOfTheSensorStayAsTheyAre) {
  for (const double period_ns : {20e6, 10e6, 6'010'240.3, 4e6, 125e3}) {
    for (const double lost_share : {0.0, 0.05, 0.4}) {
      const std::vector<TimeNs> times_ns = regular(5000, period_ns, lost_share);
      EXPECT_EQ(times_of(times_ns), times_ns) << period_ns << " ns, lost " << lost_share;
    }
  }
  std::vector<TimeNs> microseconds = regular(5000, 1'000'123.0);
  for (TimeNs& time_ns : microseconds) time_ns -= time_ns % 1000;
  EXPECT_EQ(times_of(microseconds), microseconds);
}

// Compares the filter's variance, 1.25 T / memory (Morrison, eq. 13.5 for a long memory), with the measured variance.
TEST(SampleClock, ErrsByWhatItsMemoryLeaves) {
  for (const double period_ns : {10e6, 4e6, 1e6}) {
    const double jitter_ns = 0.1 * period_ns;
    const std::vector<TimeNs> times_ns = regular(40'000, period_ns);
    const double stated_ns = jitter_ns * std::sqrt(1.25 * period_ns * 1e-9 / SampleClock::Params::kFitTimeConstant_s);
    const double measured_ns = spread_ns(times_of(jittered(times_ns, jitter_ns)), times_ns, 5000);
    EXPECT_NEAR(measured_ns / stated_ns, 1.0, 0.15) << period_ns;  // some hundred memories, so 7 % of random error
  }
}

TEST(SampleClock, FollowsAPeriodThatNobodyStatedThroughLostSamples) {
  for (const double period_ns : {20e6, 10'037'000.0, 6'010'240.3, 2e6}) {
    for (const double lost_share : {0.0, 0.1, 0.3}) {
      const double jitter_ns = 0.12 * period_ns;
      const std::vector<TimeNs> times_ns = regular(3000, period_ns, lost_share);
      const std::vector<TimeNs> stamps_ns = jittered(times_ns, jitter_ns);
      const std::vector<TimeNs> found = times_of(stamps_ns);
      EXPECT_TRUE(rise(found));
      EXPECT_LT(spread_ns(found, times_ns, 300), 0.25 * jitter_ns) << period_ns << " ns, lost " << lost_share;
      // the estimate is better than the time stamps from the start
      EXPECT_LT(spread_ns(found, times_ns, 0), 0.6 * jitter_ns);
    }
  }
}

TEST(SampleClock, ReportsTheJitterAndRepairsNoneThatItMustKeep) {
  const std::vector<TimeNs> times_ns = regular(2000, 4e6);
  std::vector<TimeNs> stamps_ns = jittered(times_ns, 5e5);
  double corrected_jitter_s = 0.0;
  std::vector<TimeNs> mended_ns = stamps_ns;
  ASSERT_TRUE(correct_stamps(SampleClock({}), mended_ns, corrected_jitter_s).ok());
  EXPECT_NEAR(corrected_jitter_s, 5e-4, 1e-4);
  EXPECT_NE(mended_ns, stamps_ns);
  EXPECT_EQ(times_of(stamps_ns, {.correctable_jitter_max_periods = 0.0}), stamps_ns);
}

TEST(SampleClock, LeavesASensorWithoutAPeriod) {
  std::mt19937_64 random(3);
  std::exponential_distribution<double> wait(1.0 / 5e6);
  std::vector<TimeNs> stamps_ns = {kStart_ns};
  while (stamps_ns.size() < 5000) stamps_ns.push_back(stamps_ns.back() + 100'000 + std::llround(wait(random)));
  const std::vector<TimeNs> found = times_of(stamps_ns);
  EXPECT_TRUE(rise(found));
  std::size_t moved = 0;
  for (std::size_t k = 0; k < found.size(); ++k) moved += found[k] != stamps_ns[k] ? 1 : 0;
  EXPECT_EQ(moved, 0u);
}

// The period drifts by 3 % within four seconds; its stamps are the truth, and the line does not follow them.
TEST(SampleClock, LeavesASensorWhosePeriodWanders) {
  std::vector<TimeNs> stamps_ns;
  double time_ns = 0.0;
  for (int k = 0; k < 4000; ++k) {
    stamps_ns.push_back(kStart_ns + std::llround(time_ns));
    time_ns += 1e7 * (1.0 + 0.03 * std::sin(2.0 * 3.14159265358979 * time_ns / 4e9));
  }
  EXPECT_LT(largest_ns(times_of(stamps_ns), stamps_ns), 0.1 * 1e7);
}

// The host stops for 35 ms, and stamps the waiting samples at once when it continues.
TEST(SampleClock, IsNotLostInABurst) {
  const std::vector<TimeNs> times_ns = regular(3000, 1e7);
  std::vector<TimeNs> stamps_ns = jittered(times_ns, 3e5);
  for (std::size_t k = 1000; k < 1004; ++k)
    stamps_ns[k] = times_ns[1003] + 5'000'000 + static_cast<TimeNs>(k - 1000) * 100'000;
  const std::vector<TimeNs> found = times_of(stamps_ns);
  EXPECT_TRUE(rise(found));
  for (std::size_t k = 100; k < 990; ++k) EXPECT_LT(std::abs(double(found[k] - times_ns[k])), 3e5);
  for (std::size_t k = 1060; k < found.size(); ++k) EXPECT_LT(std::abs(double(found[k] - times_ns[k])), 3e5) << k;
  const std::vector<TimeNs> in_burst(found.begin() + 1000, found.begin() + 1060);
  const std::vector<TimeNs> stamped(stamps_ns.begin() + 1000, stamps_ns.begin() + 1060);
  EXPECT_LE(largest_ns(in_burst, stamped), 0.5e7 + 1e5);
}

TEST(SampleClock, GoesOnBehindAGapAndAJumpOfTheClock) {
  std::vector<TimeNs> times_ns = regular(6000, 4e6);
  // time stamps on the clock line
  for (std::size_t k = 2000; k < times_ns.size(); ++k) times_ns[k] += 1'000'000'000;
  // time stamps off the clock line
  for (std::size_t k = 4000; k < times_ns.size(); ++k) times_ns[k] += 7'000'000 + 1'850'000;
  const std::vector<TimeNs> found = times_of(jittered(times_ns, 3e5));
  EXPECT_TRUE(rise(found));
  const auto worst_ns = [&](std::size_t from, std::size_t to) {
    double worst = 0.0;
    for (std::size_t k = from; k < to; ++k) worst = std::max(worst, std::abs(double(found[k] - times_ns[k])));
    return worst;
  };
  EXPECT_LT(worst_ns(500, 2000), 1.5e5);
  EXPECT_LT(worst_ns(2000, 2200), 3e5);
  EXPECT_LT(worst_ns(4500, 6000), 1.5e5);
  EXPECT_LT(worst_ns(4000, 4500), 2e6 + 9e5);  // at most half a period from its time stamp
}

// The device is set to a tenfold rate.
TEST(SampleClock, IsCaughtUpByFasterStamps) {
  std::vector<TimeNs> times_ns = regular(1000, 1e7);
  for (int k = 1; k <= 4000; ++k) times_ns.push_back(times_ns[999] + k * TimeNs{1'000'000});
  std::vector<TimeNs> stamps_ns = jittered(times_ns, 1e5);
  const std::vector<TimeNs> found = times_of(stamps_ns);
  EXPECT_TRUE(rise(found));
  EXPECT_LE(largest_ns(found, stamps_ns), 0.5e7 + 1e5);
  double worst_ns = 0.0;
  for (std::size_t k = 1500; k < found.size(); ++k)
    worst_ns = std::max(worst_ns, std::abs(double(found[k] - times_ns[k])));
  EXPECT_LT(worst_ns, 1e5);
}

TEST(SampleClock, TakesStampsFromOneEndOfTimeToTheOther) {
  const SampleClock clock({});
  SampleClock::State state;
  TimeNs time_ns = 0, last_ns = std::numeric_limits<TimeNs>::min();
  ASSERT_TRUE(clock.push(last_ns, state, time_ns).ok());
  for (int k = 0; k < 100; ++k) {
    ASSERT_TRUE(clock.push(last_ns += TimeNs{1} << 57, state, time_ns).ok());
    EXPECT_EQ(time_ns, last_ns);
  }
  ASSERT_TRUE(clock.push(std::numeric_limits<TimeNs>::max(), state, time_ns).ok());
  EXPECT_EQ(time_ns, std::numeric_limits<TimeNs>::max());
}

TEST(SampleClock, RefusesAStampThatIsNotLater) {
  const SampleClock clock({});
  SampleClock::State state;
  TimeNs time_ns = 0;
  for (const TimeNs stamp_ns : jittered(regular(100, 1e7), 1e6)) ASSERT_TRUE(clock.push(stamp_ns, state, time_ns).ok());
  const TimeNs last_ns = *state.last_stamp_ns, given_ns = time_ns;
  for (const TimeNs stamp_ns : {last_ns, last_ns - 1, TimeNs{0}}) {
    const Status status = clock.push(stamp_ns, state, time_ns);
    EXPECT_EQ(status.error_code, ErrorCode::time_order);
    EXPECT_EQ(status.bound, double(last_ns));
  }
  EXPECT_EQ(time_ns, given_ns);
  ASSERT_TRUE(clock.push(last_ns + 1, state, time_ns).ok());
  EXPECT_GT(time_ns, given_ns);
}

TEST(SampleClock, RefusesParametersBeyondTheirBounds) {
  EXPECT_THROW(SampleClock({.correctable_jitter_max_periods = -0.1}), InvalidParams);
  EXPECT_THROW(SampleClock({.correctable_jitter_max_periods = 0.5}), InvalidParams);
}

}  // namespace
}  // namespace tumble
