// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/slam_conclusion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/sweep_log.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kRests_m = 0.01, kRests_rad = 0.01;  // largest motion over one sweep of a stationary rig

/// Adds the median and the 90th percentile of the Mahalanobis distance between predicted and registered poses to the
/// health.
void report_innovations(Estimate& estimate) {
  std::vector<double> all;
  for (const auto& sweep : estimate.sweeps) {
    if (sweep.innovation > 0.0) all.push_back(sweep.innovation);
  }
  if (all.empty()) return;
  std::sort(all.begin(), all.end());
  estimate.health["innovation_median"] = all[all.size() / 2];
  estimate.health["innovation_90"] = all[all.size() * 9 / 10];
}

/// Returns true if the rig is stationary during the sweep. Unconstrained directions are then harmless, although the
/// lidar measures the same rings repeatedly.
bool rests(const SweepReport& sweep) {
  if (sweep.trajectory.size() < 2) return false;
  const PoseState &first = sweep.trajectory.front(), &last = sweep.trajectory.back();
  return (last.p_WA_m - first.p_WA_m).norm() < kRests_m && first.q_WA.angularDistance(last.q_WA) < kRests_rad;
}

/// Returns the fraction of registered sweeps among the sweeps during motion. Registered means that the surfaces
/// constrain all directions.
double well_constrained_share(std::span<const SweepReport> sweeps) {
  std::size_t constrained = 0, moving = 0;
  for (const SweepReport& sweep : sweeps) {
    if (rests(sweep)) continue;
    ++moving;
    constrained += sweep.verdict == SweepVerdict::registered;
  }
  return moving > 0 ? static_cast<double>(constrained) / static_cast<double>(moving) : 1.0;
}

/// Adds the uncertainty of the final pose to the health. A large value means that the surroundings constrain the pose
/// poorly.
void report_end(const Localisation& localisation, Estimate& estimate) {
  const Eigen::Matrix<double, 6, 6>& P = estimate.sweeps.back().pose.covariance;
  estimate.health["end_sigma_m"] = std::sqrt(P.topLeftCorner<3, 3>().trace());
  estimate.health["end_sigma_rad"] = std::sqrt(P.bottomRightCorner<3, 3>().trace());
  estimate.health["well_constrained_share"] = well_constrained_share(estimate.sweeps);
  estimate.health["sigma_largest_m"] = localisation.largest_sigma_m();
  estimate.health["innovation_second"] = localisation.second_largest_innovation();
}

void report_scale(const SweepScale& scale, Estimate& estimate) {
  estimate.health["lidar_scale_changes"] = static_cast<double>(scale.changes);
  if (!std::isfinite(scale.sigma)) return;
  estimate.health["lidar_scale"] = scale.scale;
  estimate.health["lidar_scale_sigma"] = scale.sigma;
}

Status any_registered(std::span<const SweepReport> sweeps) {
  const bool any = std::any_of(sweeps.begin(), sweeps.end(),
                               [](const SweepReport& sweep) { return sweep.verdict != SweepVerdict::rejected; });
  return any ? Status{} : Status{ErrorCode::too_few, "lidar.sweeps_registered", 0.0, 1.0};
}

}  // namespace

void apply_smoothed(std::vector<PoseState> smoothed, SweepReport& sweep) {
  if (smoothed.empty()) return;
  sweep.trajectory = std::move(smoothed);
  sweep.pose = sweep.trajectory.back();
}

bool conclude(const LidarInertialOdometry& odometry, const Localisation& localisation, const SweepScale* scale,
              Estimate& estimate) {
  for (const SweepReport& sweep : estimate.sweeps) append_poses(sweep.trajectory, estimate);
  report_innovations(estimate);
  if (!estimate.sweeps.empty()) report_end(localisation, estimate);
  const bool localised = !estimate.sweeps.empty() && report_localised(estimate);
  if (scale) report_scale(*scale, estimate);
  estimate.map = odometry.map();
  estimate.status = any_registered(estimate.sweeps);
  return localised && estimate.status.ok();
}

void report_calibration(const LidarInertialOdometry& odometry, const sim::Sensors& sensors,
                        std::map<std::string, double>& health) {
  SweepCalibration given;
  given.T_IL = bridge::T_IL(sensors.imus.front(), sensors.lidars.front());
  const auto moved = odometry.calibration().minus(given);
  health["calibration_rotation_rad"] = moved.head<3>().norm();
  health["calibration_translation_m"] = moved.segment<3>(3).norm();
  health["calibration_time_offset_s"] = moved[6];
}

void report_passes(const MappedRecording& mapped, std::map<std::string, double>& health) {
  if (mapped.passes > 1) health["passes"] = mapped.passes;
  health["lidar_calibration_mahalanobis"] = mapped.calibration_deviations;
  health["calibration_unconverged"] = mapped.calibration_converged ? 0.0 : 1.0;
}

}  // namespace tumble::scenarios
