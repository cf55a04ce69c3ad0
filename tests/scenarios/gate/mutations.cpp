// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/gate/mutations.hpp"

#include <algorithm>
#include <array>

namespace tumble::scenarios::testing {

namespace {

constexpr double kShift_ns = 1e6;
constexpr double kBumpLeast_m = 0.004;  // above its height at the start, the sphere stands on something
constexpr double kMapRotation_rad = 0.02;

/// Every IMU on the other side of the body's origin.
void flip_lever_arms(sim::Sensors& sensors) {
  for (sim::ImuRecord& imu : sensors.imus) imu.T_BI.translation() *= -1.0;
}

/// The lidar's place in the body added where it has to be taken away.
void flip_lever_arm_of_poses(const sim::Recording& recording, Estimate& estimate) {
  const Eigen::Vector3d arm = recording.sensors.lidars.front().T_BL.translation();
  const auto flip = [&](PoseState& pose) { pose.p_WA_m += 2.0 * (pose.q_WA * arm); };
  for (PoseState& pose : estimate.poses) flip(pose);
  for (auto& sweep : estimate.sweeps) {
    flip(sweep.pose);
    for (PoseState& pose : sweep.trajectory) flip(pose);
  }
}

void halve_covariances(const sim::Recording&, Estimate& estimate) {
  for (RateState& rate : estimate.rates) rate.covariance_rad2_s2 *= 0.5;
  for (AttitudeState& attitude : estimate.attitudes) attitude.covariance_rad2 *= 0.5;
  for (PoseState& pose : estimate.poses) pose.covariance *= 0.5;
  for (auto& sweep : estimate.sweeps) sweep.pose.covariance *= 0.5;
}

void double_covariances(const sim::Recording&, Estimate& estimate) {
  for (RateState& rate : estimate.rates) rate.covariance_rad2_s2 *= 2.0;
  for (AttitudeState& attitude : estimate.attitudes) attitude.covariance_rad2 *= 2.0;
  for (PoseState& pose : estimate.poses) pose.covariance *= 2.0;
  for (auto& sweep : estimate.sweeps) sweep.pose.covariance *= 2.0;
}

/// The first segment of the truth that lies higher than the start: [begin, end] in ns; empty without one.
std::array<std::int64_t, 2> first_bump_ns(const sim::Truth& truth) {
  std::array<std::int64_t, 2> bump = {0, 0};
  for (std::size_t k = 0; k < truth.p_WB_m.size(); ++k) {
    const bool up = truth.p_WB_m[k].z() > truth.p_WB_m.front().z() + kBumpLeast_m;
    const std::int64_t time_ns = static_cast<std::int64_t>(k) * truth.period_ns;
    if (up && bump[0] == 0) bump[0] = time_ns;
    if (up && bump[0] != 0) bump[1] = time_ns;
    if (!up && bump[1] > bump[0] + 50'000'000) break;
  }
  return bump;
}

/// The way over the first bump is not counted: the estimate stays where it met it.
void lose_a_bump(const sim::Recording& recording, Estimate& estimate) {
  const auto [begin_ns, end_ns] = first_bump_ns(recording.truth);
  Eigen::Vector3d met = Eigen::Vector3d::Zero(), lost = Eigen::Vector3d::Zero();
  for (PoseState& pose : estimate.poses) {
    if (pose.time_ns <= begin_ns) met = pose.p_WA_m;
    if (pose.time_ns > begin_ns && pose.time_ns <= end_ns) lost = pose.p_WA_m - met;
    if (pose.time_ns > begin_ns) pose.p_WA_m -= pose.time_ns <= end_ns ? Eigen::Vector3d(pose.p_WA_m - met) : lost;
  }
}

/// How far towards the state before lies what was true one millisecond ago.
template <typename State>
double share_of_shift(const State& before, const State& now) {
  return std::min(1.0, kShift_ns / static_cast<double>(now.time_ns - before.time_ns));
}

void shift_poses(std::vector<PoseState>& poses) {
  for (std::size_t k = poses.size(); k-- > 1;) {
    const double share = share_of_shift(poses[k - 1], poses[k]);
    poses[k].p_WA_m += share * (poses[k - 1].p_WA_m - poses[k].p_WA_m);
    poses[k].q_WA = poses[k].q_WA.slerp(share, poses[k - 1].q_WA);
  }
}

/// What was true one millisecond before, under the stamps of now: linear between states.
void shift_by_1_ms(const sim::Recording&, Estimate& estimate) {
  for (std::size_t k = estimate.rates.size(); k-- > 1;) {
    RateState &now = estimate.rates[k], &before = estimate.rates[k - 1];
    now.w_WI_I_rad_s += share_of_shift(before, now) * (before.w_WI_I_rad_s - now.w_WI_I_rad_s);
  }
  for (std::size_t k = estimate.attitudes.size(); k-- > 1;) {
    AttitudeState &now = estimate.attitudes[k], &before = estimate.attitudes[k - 1];
    now.q_WA = now.q_WA.slerp(share_of_shift(before, now), before.q_WA);
  }
  shift_poses(estimate.poses);
  for (auto& sweep : estimate.sweeps) {
    if (sweep.trajectory.size() < 2) continue;
    shift_poses(sweep.trajectory);
    sweep.pose.p_WA_m = sweep.trajectory.back().p_WA_m;
    sweep.pose.q_WA = sweep.trajectory.back().q_WA;
  }
}

/// Every point a second time, at its very place.
void draw_map_twice(const sim::Recording&, Estimate& estimate) {
  const std::vector<MapPoint> once = estimate.map;
  estimate.map.insert(estimate.map.end(), once.begin(), once.end());
}

/// Every point a second time, from a pose that was a degree off.
void draw_map_twice_turned(const sim::Recording&, Estimate& estimate) {
  if (estimate.poses.empty()) return;
  const Eigen::Vector3d centre = estimate.poses.front().p_WA_m;
  const Eigen::AngleAxisd turn(kMapRotation_rad, Eigen::Vector3d::UnitZ());
  const std::vector<MapPoint> once = estimate.map;
  for (MapPoint point : once) {
    point.position_W_m = (turn * (point.position_W_m.cast<double>() - centre) + centre).cast<float>();
    estimate.map.push_back(point);
  }
}

}  // namespace

std::span<const Mutation> mutations() {
  static const std::array all = {
      Mutation{"lever_arm_sign_given", "hill", "rate/tumble", flip_lever_arms, nullptr},
      Mutation{"lever_arm_sign_of_poses", "hill", "slam/tumble", nullptr, flip_lever_arm_of_poses},
      Mutation{"covariance_halved_rate", "hill", "rate/tumble", nullptr, halve_covariances},
      Mutation{"covariance_halved_slam", "hill", "slam/tumble", nullptr, halve_covariances},
      Mutation{"covariance_halved_position", "bump", "position/tumble", nullptr, halve_covariances},
      Mutation{"covariance_doubled_rate", "hill", "rate/tumble", nullptr, double_covariances},
      Mutation{"covariance_doubled_slam", "hill", "slam/tumble", nullptr, double_covariances},
      Mutation{"covariance_doubled_position", "bump", "position/tumble", nullptr, double_covariances},
      Mutation{"lost_bump", "bump", "position/tumble", nullptr, lose_a_bump},
      Mutation{"shift_1_ms", "hill", "rate/tumble", nullptr, shift_by_1_ms},
      Mutation{"shift_1_ms_live", "hill", "rate/tumble_lag", nullptr, shift_by_1_ms},
      Mutation{"shift_1_ms_poses", "hill", "slam/tumble", nullptr, shift_by_1_ms},
      Mutation{"lever_arm_sign_given_live", "hill", "rate/tumble_lag", flip_lever_arms, nullptr},
      Mutation{"covariance_halved_live", "hill", "rate/tumble_lag", nullptr, halve_covariances},
      Mutation{"covariance_doubled_live", "hill", "rate/tumble_lag", nullptr, double_covariances},
      Mutation{"shift_1_ms_position", "bump", "position/tumble", nullptr, shift_by_1_ms},
      Mutation{"shift_1_ms_position_live", "bump", "position/tumble_live", nullptr, shift_by_1_ms},
      Mutation{"covariance_halved_position_live", "bump", "position/tumble_live", nullptr, halve_covariances},
      Mutation{"lost_bump_live", "bump", "position/tumble_live", nullptr, lose_a_bump},
      Mutation{"covariance_halved_sphere_attitude", "bump", "attitude/tumble", nullptr, halve_covariances},
      Mutation{"shift_1_ms_carried", "swing", "rate/tumble", nullptr, shift_by_1_ms},
      Mutation{"covariance_halved_carried", "swing", "rate/tumble", nullptr, halve_covariances},
      Mutation{"covariance_doubled_carried", "swing", "rate/tumble", nullptr, double_covariances},
      Mutation{"shift_1_ms_held", "swing", "rate/carried", nullptr, shift_by_1_ms},
      Mutation{"covariance_halved_held", "swing", "rate/carried", nullptr, halve_covariances},
      Mutation{"covariance_doubled_held", "swing", "rate/carried", nullptr, double_covariances},
      Mutation{"shift_1_ms_position_lag", "bump", "position/tumble_lag", nullptr, shift_by_1_ms},
      Mutation{"covariance_halved_position_lag", "bump", "position/tumble_lag", nullptr, halve_covariances},
      Mutation{"shift_1_ms_attitude", "swing", "attitude/tumble", nullptr, shift_by_1_ms},
      Mutation{"covariance_halved_attitude", "swing", "attitude/tumble", nullptr, halve_covariances},
      Mutation{"covariance_doubled_attitude", "swing", "attitude/tumble", nullptr, double_covariances},
      Mutation{"map_twice", "hill", "slam/tumble", nullptr, draw_map_twice},
      Mutation{"map_twice_turned", "hill", "slam/tumble", nullptr, draw_map_twice_turned},
  };
  return all;
}

}  // namespace tumble::scenarios::testing
