// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "hand_held_readings.hpp"

namespace tumble::hand_held {

using Eigen::Vector3d;

namespace {

// If the angular jerk is white noise of density q, the second difference of rate readings with period P has the
// variance `kSecondDifference` q P^3.
constexpr double kSecondDifference = 11.0 / 20.0, kJerkSpan_periods = 1.5;

bool is_free(const GyroReadings& rates, std::size_t k, Eigen::Index axis) {
  return rates.clip_signs[k].gyro[static_cast<std::size_t>(axis)] == 0 &&
         !(rates.partial_saturation_sigma_rad_s[k][axis] > 0.0);
}

struct SampleRange {
  std::size_t first = 0, last = 0;
  SampleRange(double from_s, double to_s, double node_s, std::size_t nodes)
      : first(static_cast<std::size_t>(std::max(0.0, std::ceil(from_s / node_s)))),
        last(std::min(nodes, static_cast<std::size_t>(std::max(0.0, std::floor(to_s / node_s) + 1.0)))) {}
};

// See carried.md (C24).
void add_jerk_from_curvature(const GyroReadings& rates, const Eigen::Matrix3d& rows, double noise_rad_s, double node_s,
                             std::vector<double>& densities) {
  const double period_s = rates.averaging_windows.period_s, reach_s = kJerkSpan_periods * std::max(period_s, node_s);
  const double unit = kSecondDifference * period_s * period_s * period_s;
  std::vector<double> counts(densities.size(), 0.0);
  for (std::size_t k = 1; k + 1 < rates.samples.size(); ++k) {
    if (rates.averaging_windows.end_s[k + 1] - rates.averaging_windows.end_s[k - 1] > 2.0 * kLongest * period_s)
      continue;
    const Vector3d bend = rates.samples[k + 1].angular_velocity_rad_s - 2.0 * rates.samples[k].angular_velocity_rad_s +
                          rates.samples[k - 1].angular_velocity_rad_s;
    double sum = 0.0, count = 0.0;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (!is_free(rates, k - 1, axis) || !is_free(rates, k, axis) || !is_free(rates, k + 1, axis)) continue;
      const double along = rows.row(axis).dot(bend);
      sum += along * along - 6.0 * noise_rad_s * noise_rad_s;
      count += 1.0;
    }
    const double at_s = rates.averaging_windows.window_centre_s[k];
    const SampleRange reach(at_s - reach_s, at_s + reach_s, node_s, densities.size());
    for (std::size_t i = reach.first; i < reach.last; ++i) densities[i] += sum / unit, counts[i] += count;
  }
  for (std::size_t i = 0; i < densities.size(); ++i)
    densities[i] = counts[i] > 0.0 ? std::max(0.0, densities[i] / counts[i]) : 0.0;
}

bool unclipped_slope_of(const GyroReadings& rates, const Eigen::Matrix3d& rows, std::size_t k, Eigen::Index axis,
                        double& slope, double& at_s) {
  if (!is_free(rates, k, axis) || !is_free(rates, k + 1, axis)) return false;
  const double dt_s = rates.averaging_windows.window_centre_s[k + 1] - rates.averaging_windows.window_centre_s[k];
  if (!(dt_s > 0.0) || dt_s > kLongest * rates.averaging_windows.period_s) return false;
  slope =
      rows.row(axis).dot(rates.samples[k + 1].angular_velocity_rad_s - rates.samples[k].angular_velocity_rad_s) / dt_s;
  at_s = 0.5 * (rates.averaging_windows.window_centre_s[k] + rates.averaging_windows.window_centre_s[k + 1]);
  return true;
}

// See carried.md (C25).
void add_jerk_from_clipped_slopes(const GyroReadings& rates, const Eigen::Matrix3d& rows, double noise_rad_s,
                                  double node_s, std::vector<double>& densities) {
  const std::size_t count = rates.samples.size();
  const double noise = 2.0 * noise_rad_s / rates.averaging_windows.period_s;  // noise of the difference of two slopes
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (std::size_t begin = 2; begin + 2 < count;) {
      if (is_free(rates, begin, axis)) {
        ++begin;
        continue;
      }
      std::size_t end = begin;
      while (end < count && !is_free(rates, end, axis)) ++end;
      double in = 0.0, out = 0.0, from_s = 0.0, to_s = 0.0;
      const bool determined = end + 1 < count && unclipped_slope_of(rates, rows, begin - 2, axis, in, from_s) &&
                              unclipped_slope_of(rates, rows, end, axis, out, to_s);
      if (determined) {
        const double density = ((out - in) * (out - in) - noise * noise) / (to_s - from_s);
        const SampleRange reach(from_s, to_s, node_s, densities.size());
        for (std::size_t i = reach.first; i < reach.last; ++i) densities[i] = std::max(densities[i], density);
      }
      begin = end;
    }
  }
}

}  // namespace

std::vector<double> estimate_jerk(const GyroReadings& rates, const Eigen::Matrix3d& rows, double noise_rad_s,
                                  double node_s, std::size_t nodes) {
  std::vector<double> out(nodes, 0.0);
  add_jerk_from_curvature(rates, rows, noise_rad_s, node_s, out);
  add_jerk_from_clipped_slopes(rates, rows, noise_rad_s, node_s, out);
  for (double& density : out) density = std::sqrt(density);
  return out;
}

}  // namespace tumble::hand_held
