// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/people.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "scenarios/scoring/truth_track.hpp"

namespace tumble::bench {

namespace {

constexpr double kRadius_m = 0.25, kHeight_m = 1.75, kSpeed_m_s = 1.2;
constexpr std::array<double, 3> kCircle_m = {2.5, 4.0, 6.0};

/// Returns the centres of the people at a given time.
std::array<Eigen::Vector2d, 3> people_at(double t_s, const Eigen::Vector3d& start_W_m) {
  std::array<Eigen::Vector2d, 3> out;
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double angle = 2.1 * static_cast<double>(k) + (k == 1 ? -1.0 : 1.0) * kSpeed_m_s * t_s / kCircle_m[k];
    out[k] = start_W_m.head<2>() + kCircle_m[k] * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }
  return out;
}

/// Returns where a ray meets an upright cylinder, as a fraction of the ray's length.
std::optional<double> meets(const Eigen::Vector3d& from, const Eigen::Vector3d& ray, const Eigen::Vector2d& centre,
                            double floor_m) {
  const Eigen::Vector2d away = from.head<2>() - centre, d = ray.head<2>();
  const double a = d.squaredNorm(), b = away.dot(d), c = away.squaredNorm() - kRadius_m * kRadius_m;
  const double root = b * b - a * c;
  if (root <= 0.0 || a < 1e-12) return std::nullopt;
  const double share = (-b - std::sqrt(root)) / a;
  const double height_m = from.z() + share * ray.z() - floor_m;
  if (share <= 0.0 || height_m < 0.0 || height_m > kHeight_m) return std::nullopt;
  return share;
}

}  // namespace

void let_people_walk(const sim::Truth& truth, sim::Sensors& sensors) {
  const scenarios::TruthTrack track(truth, scenarios::Frame::body);
  const Eigen::Vector3d start_W_m = truth.p_WB_m.front();
  for (std::size_t l = 0; l < sensors.lidars.size(); ++l) {
    sim::LidarRecord& lidar = sensors.lidars[l];
    const sim::LidarTruth& of_lidar = truth.lidars.at(l);
    for (std::size_t sweep = 0; sweep < lidar.sweep_start_ns.size(); ++sweep) {
      for (std::size_t k = lidar.sweep_first[sweep]; k < lidar.sweep_first[sweep + 1]; ++k) {
        const std::int64_t time_ns = lidar.sweep_start_ns[sweep] + lidar.offset_ns[k];
        if (of_lidar.surface_id[k] < 0 || !track.covers(time_ns)) continue;
        const PoseState pose = track.pose(time_ns);
        const Eigen::Vector3d from = pose.position_W_m + pose.orientation_W * of_lidar.T_BL.translation();
        const Eigen::Vector3d ray = of_lidar.hit_W_m[k].cast<double>() - from;
        double nearest = 1.0;
        for (const Eigen::Vector2d& centre : people_at(1e-9 * static_cast<double>(time_ns), start_W_m)) {
          const std::optional<double> share = meets(from, ray, centre, start_W_m.z() - 0.3);
          if (share) nearest = std::min(nearest, *share);
        }
        if (nearest == 1.0) continue;
        const double shorter_m = (1.0 - nearest) * ray.norm(), range_m = lidar.range_m[k];
        lidar.position_L_m[k] *= static_cast<float>((range_m - shorter_m) / range_m);
        lidar.range_m[k] = static_cast<float>(range_m - shorter_m);
      }
    }
  }
}

}  // namespace tumble::bench
