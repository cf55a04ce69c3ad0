// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/rate_baseline.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/sample_times.hpp"
#include "scenarios/methods/slam_registry.hpp"
#include "scenarios/methods/slam_settings.hpp"

namespace tumble::scenarios {

namespace {

const Settings<SlamParams>& slam_tumble_gyro_only_settings() {
  static const Settings<SlamParams> all =
      slam_settings(with_few_matches(with_calibration(with_saturation_deficit({}))));
  return all;
}

/// Initial value for a clipped rate. The value is `readings` times the reading, plus a fraction of the excess of the
/// cubic over the reading in the gap.
struct Guess {
  double readings, share_of_cubic;
};
/// Guesses are sorted by the number of maps that succeed (docs/figures.md). Registration converges from within about 3
/// rad/s of the true rate, so gaps of different lengths need different values.
constexpr std::array<Guess, 10> kGuesses = {{{1.0, 0.7},
                                             {1.2, 0.0},
                                             {1.0, 1.0},
                                             {1.0, 0.5},
                                             {1.6, 0.0},
                                             {1.0, 0.85},
                                             {1.4, 0.0},
                                             {1.0, 0.0},
                                             {1.0, 0.3},
                                             {1.0, 1.5}}};

/// Interpolates each gap of each axis by a cubic. Saturation levels may be tilted planes.
Status cubic_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples, std::vector<RateState>& out) {
  baselines::ClippedBaseline::Params params;
  params.tilted_rails = true;
  params.rails = stated_rails(sensors.imus.front());
  return baselines::ClippedBaseline(params).estimate(samples, out);
}

std::vector<RateState> guessed_rates(const Guess& guess, std::span<const ImuSample> samples,
                                     std::vector<RateState> cubic) {
  for (std::size_t k = 0; k < cubic.size(); ++k) {
    const Eigen::Vector3d& read = samples[k].angular_velocity_rad_s;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(cubic[k].clipped_axes >> axis & 1)) continue;
      double& rate = cubic[k].w_WI_I_rad_s[axis];
      rate = guess.readings * read[axis] + guess.share_of_cubic * (rate - read[axis]);
    }
  }
  return cubic;
}

Estimate run_slam_tumble_gyro_only(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  std::vector<ImuSample> samples;
  const Estimate begun =
      begin_with_rates(sensors, samples, [&](Estimate& out) { return cubic_rates(sensors, samples, out.rates); });
  if (!begun.status.ok()) return begun;
  Estimate first;
  for (std::size_t k = 0; k < kGuesses.size(); ++k) {
    Estimate estimate = begun;
    estimate.rates = guessed_rates(kGuesses[k], samples, begun.rates);
    const bool localised = run_slam_chain(sensors, samples, {slam_tumble_gyro_only_settings(), parameters},
                                          {.calibration = true}, estimate);
    estimate.health["guesses_of_gaps"] = static_cast<double>(k + 1);
    if (localised || !estimate.status.ok()) return estimate;
    if (k == 0) first = std::move(estimate);
  }
  first.health["guesses_of_gaps"] = static_cast<double>(kGuesses.size());
  return first;
}

}  // namespace

Method slam_tumble_gyro_only() {
  return rig_slam(
      {.name = "tumble_gyro_only",
       .doc =
           "The chain of tumble with the clipped gyro and without the accelerometer in its rates. The registration "
           "estimates the saturation deficit and tries several initial values in each gap until a map is consistent.",
       .ours = true,
       .settings = {&slam_tumble_gyro_only_settings()}},
      at_sample_times<run_slam_tumble_gyro_only>);
}

}  // namespace tumble::scenarios
