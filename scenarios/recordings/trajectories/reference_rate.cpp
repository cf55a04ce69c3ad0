// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/trajectories/reference_rate.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "scenarios/recordings/clouds/sweep_stamps.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::size_t kLeastPoses = 3;

/// Fits a parabola to the poses `first` to `last`, and returns its derivative at `time_ns`.
Eigen::Vector3d slope_rad_s(const std::vector<ReferencePose>& poses, std::size_t first, std::size_t last,
                            std::int64_t time_ns) {
  std::size_t nearest = first;
  for (std::size_t k = first; k <= last; ++k) {
    if (std::abs(poses[k].time_ns - time_ns) < std::abs(poses[nearest].time_ns - time_ns)) nearest = k;
  }
  // Times are relative to half the window, for good conditioning.
  const double unit_s = 0.5e-9 * static_cast<double>(poses[last].time_ns - poses[first].time_ns);
  Eigen::Matrix3d N = Eigen::Matrix3d::Zero(), b = Eigen::Matrix3d::Zero();
  for (std::size_t k = first; k <= last; ++k) {
    const double u = 1e-9 * static_cast<double>(poses[k].time_ns - time_ns) / unit_s;
    const Eigen::Vector3d row(1.0, u, u * u);
    N += row * row.transpose();
    b += row * rotation_vector(poses[nearest].q_WA.conjugate() * poses[k].q_WA).transpose();
  }
  return N.ldlt().solve(b).row(1).transpose() / unit_s;
}

}  // namespace

std::vector<Eigen::Vector3d> reference_rates(const std::vector<ReferencePose>& poses,
                                             std::span<const std::int64_t> times_ns) {
  std::vector<std::int64_t> stamps;
  for (const ReferencePose& pose : poses) stamps.push_back(pose.time_ns);
  const auto step = static_cast<double>(median_step_ns(stamps));
  // The window is slightly larger, so that rounding does not add or drop a sample at its edge.
  const auto reach = std::llround(1.01 * std::max(static_cast<double>(kRateWindow_ns), kRateSteps * step));
  const auto gap = std::llround(2.5 * step);
  std::vector<Eigen::Vector3d> rates(times_ns.size(),
                                     Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  std::size_t first = 0;
  for (std::size_t i = 0; i < times_ns.size(); ++i) {
    const std::int64_t time = times_ns[i];
    while (first < poses.size() && poses[first].time_ns < time - reach) ++first;
    std::size_t end = first;
    bool whole = true;
    for (; end < poses.size() && poses[end].time_ns <= time + reach; ++end)
      whole = whole && (end == first || poses[end].time_ns - poses[end - 1].time_ns <= gap);
    if (end < first + kLeastPoses || !whole) continue;
    // The window must contain a pose on both sides of the requested time.
    const bool around = poses[first].time_ns <= time - reach + gap / 2 &&
                        poses[end - 1].time_ns >= time + reach - gap / 2 && poses[first].time_ns < time &&
                        poses[end - 1].time_ns > time;
    if (around) rates[i] = slope_rad_s(poses, first, end - 1, time);
  }
  return rates;
}

}  // namespace tumble::scenarios
