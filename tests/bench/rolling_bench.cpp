// SPDX-License-Identifier: BSD-3-Clause
// The program measures the position estimate of a rolling sphere, per sample on one core at 250 Hz, along an L-shaped
// path with a period of slip. It runs the live filter, and the smoother with a lag. `held_bytes` is the memory of one
// running instance; `allocations` counts the allocations after the first sample.
#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "scenarios/baselines/rolling/rolling_odometry.hpp"
#include "tests/allocation_counter.hpp"
#include "tests/estimator/rolling/rolling_truth.hpp"
#include "tumble/rolling/detail/rolling_smoother.hpp"

namespace {

const tumble::testing::RollingTruth& truth() {
  static const tumble::testing::RollingTruth out = tumble::testing::roll(
      {.velocity_m_s = tumble::testing::l_shape, .contact_velocity_m_s = [](double t) -> Eigen::Vector3d {
         return {-tumble::testing::minimum_jerk_speed(t, 2.8, 0.8, 0.25), 0.0, 0.0};
       }});
  return out;
}

void report(benchmark::State& state, std::size_t bytes, std::size_t asked) {
  const auto count = static_cast<double>(state.iterations()) * static_cast<double>(truth().samples.size());
  state.counters["per_sample"] = benchmark::Counter(count, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["held_bytes"] = static_cast<double>(bytes);
  state.counters["allocations"] = static_cast<double>(asked);
}

void rolling_odometry(benchmark::State& state) {
  const tumble::baselines::RollingOdometry odometry{tumble::baselines::RollingOdometry::Params{}};
  for (auto _ : state) {
    tumble::baselines::RollingOdometry::State s;
    for (std::size_t k = 0; k < truth().samples.size(); ++k) {
      const tumble::ImuSample& sample = truth().samples[k];
      benchmark::DoNotOptimize(odometry.step(sample.time_ns, sample.angular_velocity_rad_s, truth().q_WI[k], s));
    }
  }
  report(state, sizeof(tumble::baselines::RollingOdometry::State), 0);
}
BENCHMARK(rolling_odometry);

void live_filter(benchmark::State& state) {
  const tumble::RollingFilter filter{tumble::RollingParams{.radius_m = tumble::testing::kRadius_m}};
  std::size_t asked = 0;
  for (auto _ : state) {
    const auto s = std::make_unique<tumble::RollingFilter::State>();
    const std::size_t before = tumble::test::allocations.count;
    for (const tumble::ImuSample& sample : truth().samples) benchmark::DoNotOptimize(filter.step(sample, *s));
    asked = tumble::test::allocations.count - before;
  }
  report(state, sizeof(tumble::RollingFilter::State), asked);
}
BENCHMARK(live_filter)->Unit(benchmark::kMillisecond);

void smoother_with_lag(benchmark::State& state) {
  tumble::RollingSmoother::Params params;
  params.filter.radius_m = tumble::testing::kRadius_m;
  params.lag_s = 1.0;
  const tumble::RollingSmoother smoother(params);
  std::vector<tumble::RollingEstimate> out;
  out.reserve(truth().samples.size());
  std::size_t bytes = 0;
  for (auto _ : state) {
    const std::size_t held_before = tumble::test::allocations.bytes;
    const auto s = std::make_unique<tumble::RollingSmoother::State>();
    out.clear();
    for (const tumble::ImuSample& sample : truth().samples) benchmark::DoNotOptimize(smoother.step(sample, *s, out));
    bytes = tumble::test::allocations.bytes - held_before;
    smoother.finish(*s, out);
  }
  report(state, bytes, 0);
}
BENCHMARK(smoother_with_lag)->Unit(benchmark::kMillisecond);

}  // namespace
