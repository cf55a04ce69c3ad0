// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "estimator/angular_velocity/tumble_recording.hpp"
#include "oracles/gaussian.hpp"

namespace tumble {

/// Returns the sensing directions of a simulated device's elements: 1 on the diagonal, off-diagonal entries with
/// deviation `sigma`.
inline Eigen::Matrix3d drawn_rows(std::uint64_t seed, double sigma) {
  oracles::Gaussian noise(seed + 7000);
  Eigen::Matrix3d rows = Eigen::Matrix3d::Identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rows(i, j) += i == j ? 0.0 : sigma * noise();
  }
  return rows;
}

/// Returns a tumble of a gyro with such elements; `sigma` 0 means aligned elements.
inline TumbleRecording tilted_tumble(std::uint64_t seed, double sigma) {
  TumbleOptions options;
  options.seed = seed;
  if (sigma > 0.0) options.gyro_rows = drawn_rows(seed, sigma);
  return make_tumble(options);
}

/// Errors over several simulated devices and tumbles, at samples in which an element is clipped, and the number of
/// elements classified as clipped.
struct Pool {
  std::vector<double> raw, ours, free_axes;
  int within = 0, axes = 0, deep = 0, found = 0, called = 0, right = 0;

  void add(const TumbleRecording& tumble, const std::vector<RateState>& states) {
    ASSERT_EQ(states.size(), tumble.samples.size());
    for (std::size_t k = 0; k < states.size(); ++k) {
      for (int j = 0; j < 3; ++j) {
        const bool clipped = (states[k].clipped_axes >> j & 1u) != 0, is_deep = std::abs(tumble.hidden[k][j]) > 0.1;
        deep += is_deep;
        found += is_deep && clipped;
        called += clipped;
        // readings within the noise of the saturation limit count as clipped
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
