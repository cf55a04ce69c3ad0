// SPDX-License-Identifier: BSD-3-Clause
#include "rate_first_guess.hpp"

#include <algorithm>
#include <cmath>

#include "tumble/angular_velocity/detail/saave.hpp"
#include "wnoj_smoother.hpp"

namespace tumble {

namespace {

using Eigen::Vector3d;

constexpr double kVarianceUnknown = 100.0;  // variance of a clipped axis at the start, (rad/s)^2

}  // namespace

std::vector<AngularRateEstimate> first_guess(std::span<const AngularRateObservation> observations,
                                             const AngularRateModelParams& model, const AngularRateModel& derived,
                                             double gap_max_s) {
  double smallest = model.kRateMax_rad_s;
  for (const AngularRateObservation& o : observations) {
    for (int j = 0; j < 3; ++j) {
      const double reading = std::abs(o.sample.angular_velocity_rad_s[j]);
      if ((o.clipping.gyro >> j & 1u) != 0) smallest = std::min(smallest, std::max(reading, 0.01));
    }
  }
  const SaturationAwareRateEstimator saave({.lever_arm_m = derived.prior_constants().lever_arm_m,
                                            .saturation_point_rad_s = std::max(0.01, 0.9999 * smallest),
                                            .gap_max_s = gap_max_s});
  SaturationAwareRateEstimator::State state;
  SaturationAwareRateEstimator::RecoveredRate recovered;
  const double measured = derived.gyro_sigma_rad_s() * derived.gyro_sigma_rad_s();
  std::vector<WnojSmoother::Measurement> readings(observations.size());
  for (std::size_t k = 0; k < observations.size(); ++k) {
    const AngularRateObservation& o = observations[k];
    if (!saave.step(o.sample, state, recovered).ok()) {
      state = {};
      (void)saave.step(o.sample, state, recovered);
    }
    readings[k] = {o.sample.time_ns, o.sample.angular_velocity_rad_s, Vector3d::Constant(measured)};
    for (int j = 0; j < 3; ++j) {
      if ((o.clipping.unusable_gyro >> j & 1u) != 0) readings[k].variance_rad2_s2[j] = kVarianceUnknown;
      if ((o.unmeasured_axes() & o.clipping.gyro & 1u << j) == 0) continue;
      const double limit = model.kRateMax_rad_s;
      readings[k].rate_rad_s[j] = std::clamp(recovered.rate_rad_s[j], -limit, limit);
      readings[k].variance_rad2_s2[j] = std::clamp(recovered.variance_rad2_s2[j], 0.25, kVarianceUnknown);
    }
  }
  std::vector<WnojSmoother::Smoothed> smoothed;
  (void)WnojSmoother({}).smooth(readings, smoothed);
  std::vector<AngularRateEstimate> out(observations.size());
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].knot = {smoothed[k].rate_rad_s, smoothed[k].acceleration_rad_s2};
  }
  return out;
}

}  // namespace tumble
