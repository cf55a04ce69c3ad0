// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/sample_times.hpp"
#include "scenarios/methods/registry.hpp"

#include "scenarios/methods/synthetic_recording.hpp"
#include "tests/testing.hpp"

namespace tumble::scenarios {
namespace {

constexpr double kJitter_ns = 6e5;  // for a period of 5 ms

/// Returns the same readings, stamped by a host with jitter.
sim::Recording stamped_by_a_host(sim::Recording recording) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (std::int64_t& time_ns : recording.sensors.imus.front().time_ns)
    time_ns += std::llround(kJitter_ns * std::clamp(normal(random), -3.0, 3.0));
  return recording;
}

Estimate run(const char* method, const sim::Recording& recording) {
  return find_methods(method).front()->run(recording.sensors, {}, {});
}

double median_error_rad_s(const Estimate& estimate, const sim::Recording& truth) {
  std::vector<double> errors;
  for (std::size_t k = 0; k < estimate.rates.size(); ++k) {
    if (estimate.rates[k].clipped_axes == 0) continue;
    errors.push_back((estimate.rates[k].w_WI_I_rad_s - truth.truth.imus.front().rate_rad_s[k]).norm());
  }
  if (errors.empty()) return std::nan("");
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
  return errors[errors.size() / 2];
}

TEST(SampleTimes, SensorsWithAClockOfTheirOwnAreGivenAsTheyAre) {
  const sim::Recording recording = testing::synthetic_rig();
  const Estimate estimate = with_sample_times(recording.sensors, [&](const sim::Sensors& given) {
    EXPECT_EQ(&given, &recording.sensors);
    return Estimate{};
  });
  EXPECT_EQ(estimate.health.count("time_stamps_corrected_s"), 0u);
}

TEST(SampleTimes, StampsOfAHostAreFixedAndRatesHaveTheOriginalStamps) {
  const sim::Recording exact = testing::synthetic_rig(), stamped = stamped_by_a_host(exact);
  const std::vector<std::int64_t>& times_ns = exact.sensors.imus.front().time_ns;
  const std::vector<std::int64_t>& stamps_ns = stamped.sensors.imus.front().time_ns;
  const Estimate estimate = with_sample_times(stamped.sensors, [&](const sim::Sensors& timed) {
    Estimate out;
    double worst_ns = 0.0;
    for (std::size_t k = 0; k < times_ns.size(); ++k) {
      const std::int64_t time_ns = timed.imus.front().time_ns[k];
      if (k > times_ns.size() / 4) worst_ns = std::max(worst_ns, std::abs(double(time_ns - times_ns[k])));
      out.rates.emplace_back().time_ns = time_ns;
      out.poses.emplace_back().time_ns = time_ns;
    }
    EXPECT_LT(worst_ns, 0.5 * kJitter_ns);
    return out;
  });
  ASSERT_EQ(estimate.rates.size(), stamps_ns.size());
  for (std::size_t k = 0; k < stamps_ns.size(); ++k) EXPECT_EQ(estimate.rates[k].time_ns, stamps_ns[k]);
  EXPECT_NE(estimate.poses.back().time_ns, stamps_ns.back());
  EXPECT_NEAR(1e9 * estimate.health.at("time_stamps_corrected_s"), kJitter_ns, 0.3 * kJitter_ns);
}

TEST(SampleTimes, StampsThatGoBackStayForTheBridgeToRefuse) {
  sim::Recording recording = stamped_by_a_host(testing::synthetic_rig());
  std::vector<std::int64_t>& stamps_ns = recording.sensors.imus.front().time_ns;
  for (std::size_t k = 1; k < stamps_ns.size(); k += 10) std::swap(stamps_ns[k - 1], stamps_ns[k]);
  EXPECT_EQ(run("rate/tumble", recording).status.error_code, ErrorCode::time_order);
}

// Readings and truth belong to the samples' own times, whatever their stamps.
TEST(SampleTimes, AHostThatJittersMovesNoRateOfOurs) {
  const sim::Recording exact = testing::synthetic_rig(), stamped = stamped_by_a_host(exact);
  for (const char* const method : {"rate/tumble", "rate/tumble_lag"}) {
    const Estimate expected = run(method, exact), found = run(method, stamped);
    ASSERT_TRUE(found.status.ok()) << method;
    ASSERT_EQ(found.rates.size(), expected.rates.size());
    EXPECT_EQ(found.rates.back().time_ns, stamped.sensors.imus.front().time_ns.back()) << method;
    const double error_rad_s = median_error_rad_s(expected, exact);
    EXPECT_LT(median_error_rad_s(found, exact), 1.2 * error_rad_s + 2e-3) << method << ' ' << error_rad_s;
  }
}

}  // namespace
}  // namespace tumble::scenarios
