// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/angular_velocity/tumble_recording.hpp"
#include "oracles/gaussian.hpp"
#include "tests/testing.hpp"

namespace tumble {

/// Returns the sensing directions of a drawn device: 1 on the diagonal, standard deviation `sigma` off the diagonal.
inline Eigen::Matrix3d drawn_rows(std::uint64_t seed, double sigma) {
  oracles::Gaussian noise(seed + 7000);
  Eigen::Matrix3d rows = Eigen::Matrix3d::Identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rows(i, j) += i == j ? 0.0 : sigma * noise();
  }
  return rows;
}

/// Returns a tumble of a gyro with these elements; `sigma` 0 means no tilt.
inline TumbleRecording tilted_tumble(std::uint64_t seed, double sigma) {
  TumbleOptions options;
  options.seed = seed;
  if (sigma > 0.0) options.gyro_rows = drawn_rows(seed, sigma);
  return make_tumble(options);
}

/// Pool contains, over several devices and tumbles, errors at samples with a saturated element, and the samples that
/// were called clipped.
struct Pool {
  std::vector<double> raw, ours, free_axes;
  int within = 0, axes = 0, deep = 0, found = 0, called = 0, right = 0;

  void add(const TumbleRecording& tumble, const std::vector<AngularRateState>& states) {
    ASSERT_EQ(states.size(), tumble.samples.size());
    for (std::size_t k = 0; k < states.size(); ++k) {
      for (int j = 0; j < 3; ++j) {
        const bool clipped = (states[k].clipped_axes >> j & 1u) != 0, is_deep = std::abs(tumble.hidden[k][j]) > 0.1;
        deep += is_deep;
        found += is_deep && clipped;
        called += clipped;
        // a reading at the saturation level within the noise counts as saturated
        right += clipped && (tumble.hidden[k][j] != 0.0 || std::abs(tumble.samples[k].angular_velocity_rad_s[j]) > 9.0);
      }
      if (tumble.hidden[k].isZero()) continue;
      const Eigen::Vector3d error = states[k].w_WI_I_rad_s - tumble.truth[k];
      raw.push_back((tumble.samples[k].angular_velocity_rad_s - tumble.truth[k]).norm());
      ours.push_back(error.norm());
      for (int j = 0; j < 3; ++j) {
        ++axes;
        within += std::abs(error[j]) <= 3.0 * std::sqrt(states[k].covariance_rad2_s2(j, j));
        if (tumble.hidden[k][j] == 0.0) free_axes.push_back(std::abs(error[j]));
      }
    }
  }
  double share_within() const { return static_cast<double>(within) / axes; }
};

}  // namespace tumble
