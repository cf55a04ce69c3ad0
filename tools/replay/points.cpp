// SPDX-License-Identifier: BSD-3-Clause
#include "tools/replay/parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "tools/pictures/map_pictures.hpp"

namespace tumble::tools {

namespace {

constexpr double kGoldenRatio = 0.6180339887498949;
constexpr float kOwn_m = 0.5f;
constexpr std::int32_t kOwnSurface = -2;  ///< robot's own body (FORMAT.md, `/truth/lidars`)

bool is_own(const sim::LidarRecord& lidar, const sim::LidarTruth* truth, std::size_t i) {
  if (truth != nullptr) return truth->surface_id[i] == kOwnSurface;
  return lidar.position_L_m[i].norm() < kOwn_m;
}

struct Return {
  std::size_t index;
  std::int64_t time_ns;
};
std::vector<Return> others(const sim::LidarRecord& lidar, const sim::LidarTruth* truth) {
  std::vector<Return> out;
  for (std::size_t sweep = 0; sweep + 1 < lidar.sweep_first.size() && sweep < lidar.sweep_start_ns.size(); ++sweep) {
    const std::size_t end = std::min<std::size_t>(lidar.sweep_first[sweep + 1], lidar.position_L_m.size());
    for (std::size_t i = lidar.sweep_first[sweep]; i < end; ++i) {
      if (!lidar.position_L_m[i].allFinite() || is_own(lidar, truth, i)) continue;
      out.push_back({i, lidar.sweep_start_ns[sweep] + static_cast<std::int64_t>(lidar.offset_ns[i])});
    }
  }
  return out;
}

}  // namespace

ReplayPoints shown_points(const sim::Sensors& sensors, const sim::Truth* truth, std::size_t most) {
  ReplayPoints points;
  if (sensors.lidars.empty()) return points;
  const sim::LidarRecord& lidar = sensors.lidars.front();
  const bool labelled = truth != nullptr && !truth->lidars.empty() &&
                        truth->lidars.front().surface_id.size() == lidar.position_L_m.size();
  const std::vector<Return> all = others(lidar, labelled ? &truth->lidars.front() : nullptr);
  points.of = all.size();
  const double share = all.empty() ? 1.0 : static_cast<double>(most) / static_cast<double>(all.size());
  std::vector<Return> kept;
  for (std::size_t i = 0; i < all.size() && kept.size() < most; ++i) {
    const double turn = static_cast<double>(i) * kGoldenRatio;
    if (share >= 1.0 || turn - std::floor(turn) < share) kept.push_back(all[i]);
  }
  std::stable_sort(kept.begin(), kept.end(), [](const Return& a, const Return& b) { return a.time_ns < b.time_ns; });
  const Eigen::Isometry3f T_BL = lidar.T_BL.cast<float>();
  for (const Return& one : kept) {
    points.p_B_m.push_back(T_BL * lidar.position_L_m[one.index]);
    points.time_ns.push_back(one.time_ns);
  }
  return points;
}

Eigen::Isometry3d true_from_given_body(const sim::Sensors& sensors, const sim::Truth& truth) {
  if (sensors.lidars.empty() || truth.lidars.empty()) return Eigen::Isometry3d::Identity();
  return truth.lidars.front().T_BL * sensors.lidars.front().T_BL.inverse();
}

std::vector<float> errors_of(const ReplayPoints& points, const Motion& motion, const Eigen::Isometry3d& T_BB_given,
                             const sim::Surface& surface) {
  std::vector<float> error_m(points.p_B_m.size(), std::numeric_limits<float>::quiet_NaN());
  std::vector<std::size_t> known;
  std::vector<Eigen::Vector3f> placed_W_m;
  for (std::size_t i = 0; i < points.p_B_m.size(); ++i) {
    const std::optional<Eigen::Isometry3d> T_WB = motion.at(points.time_ns[i]);
    if (!T_WB) continue;
    known.push_back(i);
    placed_W_m.push_back((*T_WB * T_BB_given * points.p_B_m[i].cast<double>()).cast<float>());
  }
  const std::vector<float> distances = surface.distances(placed_W_m, kMapErrorMax_m);
  for (std::size_t k = 0; k < known.size(); ++k) error_m[known[k]] = distances[k];
  return error_m;
}

}  // namespace tumble::tools
