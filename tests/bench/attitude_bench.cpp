// SPDX-License-Identifier: BSD-3-Clause
// Measures the time of attitude filters for one sample on one core [ns], for a body that turns, shakes and rests, at
// 250 Hz. The project's limits are 200 ns for the simple filters and 2000 ns for tumble. The reference C++ of VQF is
// also measured if it was found (VQF_SOURCE_DIR).
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "scenarios/baselines/attitude/autogain.hpp"
#include "scenarios/baselines/attitude/complementary.hpp"
#include "scenarios/baselines/attitude/madgwick.hpp"
#include "tumble/attitude/detail/strapdown.hpp"
#include "tumble/attitude/detail/tumble_attitude.hpp"
#include "tumble/attitude/detail/vqf.hpp"
#ifdef TUMBLE_HAS_VQF
#include "vqf.hpp"
#endif

namespace {

constexpr std::size_t kSamples = 5000;
constexpr tumble::TimeNs kPeriod_ns = 4'000'000;

/// The body moves for 15 s and rests for 5 s.
const std::vector<tumble::ImuSample>& samples() {
  static const std::vector<tumble::ImuSample> out = [] {
    std::vector<tumble::ImuSample> all(kSamples);
    for (std::size_t k = 0; k < kSamples; ++k) {
      const double t = 0.004 * static_cast<double>(k);
      const double moves = t < 15.0 ? 1.0 : 0.0;
      all[k].time_ns = static_cast<tumble::TimeNs>(k) * kPeriod_ns;
      all[k].angular_velocity_rad_s =
          moves * Eigen::Vector3d(std::sin(t), 2.0 * std::cos(1.7 * t), 0.5 * std::sin(3.1 * t));
      all[k].specific_force_m_s2 = Eigen::Vector3d(moves * std::sin(2.3 * t), moves * std::cos(1.1 * t), 9.81);
    }
    return all;
  }();
  return out;
}

template <typename Filter>
void filter(benchmark::State& state) {
  const Filter method{typename Filter::Params{}};
  for (auto _ : state) {
    typename Filter::State filter_state;
    for (const tumble::ImuSample& sample : samples()) benchmark::DoNotOptimize(method.step(sample, filter_state));
    benchmark::DoNotOptimize(filter_state);
  }
  const auto count = static_cast<double>(state.iterations()) * static_cast<double>(kSamples);
  state.counters["per_sample"] = benchmark::Counter(count, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["state_bytes"] = static_cast<double>(sizeof(typename Filter::State));
}
BENCHMARK(filter<tumble::Strapdown>)->Name("integrate");
BENCHMARK(filter<tumble::baselines::Madgwick>)->Name("madgwick");
BENCHMARK(filter<tumble::baselines::Complementary>)->Name("complementary");
BENCHMARK(filter<tumble::baselines::Autogain>)->Name("autogain");
BENCHMARK(filter<tumble::Vqf>)->Name("vqf");
BENCHMARK(filter<tumble::TumbleAttitude>)->Name("tumble");

void rolling_sphere(benchmark::State& state) {
  tumble::TumbleAttitude::Params params;
  params.radius_m = 0.145;
  const tumble::TumbleAttitude method(params);
  for (auto _ : state) {
    tumble::TumbleAttitude::State filter_state;
    for (const tumble::ImuSample& sample : samples()) benchmark::DoNotOptimize(method.step(sample, filter_state));
  }
  const auto count = static_cast<double>(state.iterations()) * static_cast<double>(kSamples);
  state.counters["per_sample"] = benchmark::Counter(count, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(rolling_sphere)->Name("tumble_on_a_sphere");

#ifdef TUMBLE_HAS_VQF
void vqf_reference(benchmark::State& state) {
  for (auto _ : state) {
    VQF reference(0.004);
    for (const tumble::ImuSample& sample : samples()) {
      reference.update(sample.angular_velocity_rad_s.data(), sample.specific_force_m_s2.data());
    }
    vqf_real_t q[4];
    reference.getQuat6D(q);
    benchmark::DoNotOptimize(q);
  }
  const auto count = static_cast<double>(state.iterations()) * static_cast<double>(kSamples);
  state.counters["per_sample"] = benchmark::Counter(count, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(vqf_reference)->Name("vqf_of_its_authors");
#endif

}  // namespace
