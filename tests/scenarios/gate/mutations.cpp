// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/gate/mutations.hpp"

#include "tests/testing.hpp"

namespace tumble::scenarios::testing {

namespace {

constexpr double kShift_ns = 1e6;
constexpr double kBumpLeast_m = 0.004;  // the sphere is on an obstacle if it is this far above its start height
constexpr double kMapRotation_rad = 0.02;
constexpr double kBorder_m_s = 0.02;
constexpr double kTilt_rad = 0.05;
constexpr double kTurn_rad_s = 0.005;
constexpr double kSink_m_s = 0.005;

/// Moves every IMU to the other side of the body's origin.
void flip_lever_arms(sim::Sensors& sensors) {
  for (sim::ImuRecord& imu : sensors.imus) imu.T_BI.translation() *= -1.0;
}

/// Adds the lidar's position in the body where it must be subtracted.
void flip_lever_arm_of_poses(const sim::Recording& recording, Estimate& estimate) {
  const Vector3d arm = recording.sensors.lidars.front().T_BL.translation();
  const auto flip = [&](PoseState& pose) { pose.position_W_m += 2.0 * (pose.orientation_W * arm); };
  for (PoseState& pose : estimate.poses) flip(pose);
  for (auto& sweep : estimate.sweeps) {
    flip(sweep.pose);
    for (PoseState& pose : sweep.trajectory) flip(pose);
  }
}

void scale_covariances(double by, Estimate& estimate) {
  for (AngularRateState& rate : estimate.rates) rate.covariance_rad2_s2 *= by;
  for (AttitudeState& attitude : estimate.attitudes) attitude.covariance_rad2 *= by;
  for (PoseState& pose : estimate.poses) pose.covariance *= by;
  for (auto& sweep : estimate.sweeps) sweep.pose.covariance *= by;
}

void halve_covariances(const sim::Recording&, Estimate& estimate) {
  scale_covariances(0.5, estimate);
}

void double_covariances(const sim::Recording&, Estimate& estimate) {
  scale_covariances(2.0, estimate);
}

/// Returns the first segment of the truth that lies higher than the start, as [begin, end] in ns; the segment is empty
/// when there is none.
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

/// Removes the path over the first bump: the estimate stays at the position where it reached the bump.
void lose_a_bump(const sim::Recording& recording, Estimate& estimate) {
  const auto [begin_ns, end_ns] = first_bump_ns(recording.truth);
  Vector3d met = Eigen::Vector3d::Zero(), lost = Eigen::Vector3d::Zero();
  for (PoseState& pose : estimate.poses) {
    if (pose.time_ns <= begin_ns) met = pose.position_W_m;
    if (pose.time_ns > begin_ns && pose.time_ns <= end_ns) lost = pose.position_W_m - met;
    if (pose.time_ns > begin_ns) pose.position_W_m -= pose.time_ns <= end_ns ? Vector3d(pose.position_W_m - met) : lost;
  }
}

/// Marks no pose as slipping or sliding.
void lose_slips(const sim::Recording&, Estimate& estimate) {
  for (sim::ContactLabel& contact : estimate.contacts) contact = sim::ContactLabel::grip;
}

/// Reports every second event half a second before it begins.
void claim_slips_early(const sim::Recording&, Estimate& estimate) {
  constexpr std::int64_t kEarly_ns = 500'000'000;
  bool early = false;
  for (std::size_t k = estimate.contacts.size(); k-- > 1;) {
    const sim::ContactLabel now = estimate.contacts[k];
    if (now != sim::ContactLabel::slip && now != sim::ContactLabel::slide) continue;
    if (estimate.contacts[k - 1] != sim::ContactLabel::grip) continue;
    early = !early;
    for (std::size_t j = k; early && j-- > 0;) {
      if (estimate.poses[k].time_ns - estimate.poses[j].time_ns > kEarly_ns) break;
      estimate.contacts[j] = now;
    }
  }
}

/// Removes the map points beyond the middle of the map.
void lose_half_the_map(const sim::Recording&, Estimate& estimate) {
  if (estimate.map.empty()) return;
  const std::size_t half = estimate.map.size() / 2;
  std::nth_element(estimate.map.begin(), estimate.map.begin() + static_cast<std::ptrdiff_t>(half), estimate.map.end(),
                   [](const MapPoint& a, const MapPoint& b) { return a.position_W_m.x() < b.position_W_m.x(); });
  estimate.map.resize(half);
}

/// Changes the velocity of every second sweep a little, so that it jumps between sweeps.
void break_sweep_borders(const sim::Recording&, Estimate& estimate) {
  for (std::size_t k = 0; k < estimate.sweeps.size(); k += 2) {
    for (PoseState& pose : estimate.sweeps[k].trajectory) pose.velocity_W_m_s.x() += kBorder_m_s;
  }
}

/// Turns the last sweeps by a degree.
void turn_the_end(const sim::Recording&, Estimate& estimate) {
  constexpr std::size_t kLast = 5;
  const Quaterniond turn(Eigen::AngleAxisd(kMapRotation_rad, Eigen::Vector3d::UnitZ()));
  for (std::size_t k = 0; k < std::min(kLast, estimate.sweeps.size()); ++k) {
    PoseState& pose = estimate.sweeps[estimate.sweeps.size() - 1 - k].pose;
    pose.orientation_W = turn * pose.orientation_W;
  }
}

/// Moves the map away from the run's path.
void move_the_map(const sim::Recording&, Estimate& estimate) {
  for (MapPoint& point : estimate.map) point.position_W_m += Vector3f(0.7f, 0.7f, 1.5f);
}

void tilt_attitudes(const sim::Recording&, Estimate& estimate) {
  const Quaterniond tilt(Eigen::AngleAxisd(kTilt_rad, Eigen::Vector3d::UnitX()));
  for (AttitudeState& attitude : estimate.attitudes) attitude.orientation_W = tilt * attitude.orientation_W;
}

/// Turns the attitudes about the vertical by an angle that grows with time.
void turn_attitudes(const sim::Recording&, Estimate& estimate) {
  for (AttitudeState& attitude : estimate.attitudes) {
    const double since_s = 1e-9 * static_cast<double>(attitude.time_ns - estimate.attitudes.front().time_ns);
    attitude.orientation_W =
        Eigen::AngleAxisd(kTurn_rad_s * since_s, Eigen::Vector3d::UnitZ()) * attitude.orientation_W;
  }
}

/// Moves the poses below the ground by a distance that grows with time.
void sink_poses(const sim::Recording&, Estimate& estimate) {
  for (PoseState& pose : estimate.poses) {
    pose.position_W_m.z() -= kSink_m_s * 1e-9 * static_cast<double>(pose.time_ns - estimate.poses.front().time_ns);
  }
}

/// Returns the share of the way to the previous state at which the value of one millisecond ago lies.
template <typename State>
double share_of_shift(const State& before, const State& now) {
  return std::min(1.0, kShift_ns / static_cast<double>(now.time_ns - before.time_ns));
}

void shift_poses(std::vector<PoseState>& poses) {
  for (std::size_t k = poses.size(); k-- > 1;) {
    const double share = share_of_shift(poses[k - 1], poses[k]);
    poses[k].position_W_m += share * (poses[k - 1].position_W_m - poses[k].position_W_m);
    poses[k].orientation_W = poses[k].orientation_W.slerp(share, poses[k - 1].orientation_W);
  }
}

/// Replaces each state by the one of a millisecond before, with the present stamp; the values are linear between
/// states.
void shift_by_1_ms(const sim::Recording&, Estimate& estimate) {
  for (std::size_t k = estimate.rates.size(); k-- > 1;) {
    AngularRateState &now = estimate.rates[k], &before = estimate.rates[k - 1];
    now.w_WI_I_rad_s += share_of_shift(before, now) * (before.w_WI_I_rad_s - now.w_WI_I_rad_s);
  }
  for (std::size_t k = estimate.attitudes.size(); k-- > 1;) {
    AttitudeState &now = estimate.attitudes[k], &before = estimate.attitudes[k - 1];
    now.orientation_W = now.orientation_W.slerp(share_of_shift(before, now), before.orientation_W);
  }
  shift_poses(estimate.poses);
  for (auto& sweep : estimate.sweeps) {
    if (sweep.trajectory.size() < 2) continue;
    shift_poses(sweep.trajectory);
    sweep.pose.position_W_m = sweep.trajectory.back().position_W_m;
    sweep.pose.orientation_W = sweep.trajectory.back().orientation_W;
  }
}

/// Adds every map point a second time at the same position.
void draw_map_twice(const sim::Recording&, Estimate& estimate) {
  const std::vector<MapPoint> once = estimate.map;
  estimate.map.insert(estimate.map.end(), once.begin(), once.end());
}

/// Adds every map point a second time, from a pose that is wrong by a degree.
void draw_map_twice_turned(const sim::Recording&, Estimate& estimate) {
  if (estimate.poses.empty()) return;
  const Vector3d centre = estimate.poses.front().position_W_m;
  const Eigen::AngleAxisd turn(kMapRotation_rad, Eigen::Vector3d::UnitZ());
  const std::vector<MapPoint> once = estimate.map;
  for (MapPoint point : once) {
    point.position_W_m = (turn * (point.position_W_m.cast<double>() - centre) + centre).cast<float>();
    estimate.map.push_back(point);
  }
}

/// A Timed contains the metrics of a method that must detect a wrong covariance and a delay of 1 ms.
struct Timed {
  std::string scenario, method;
  std::vector<std::string> halved, doubled, shifted;  ///< empty: the fault is not tested with this method
};

/// Returns the faults of covariance and time stamps, which every kind of method can have.
void add_timed(std::vector<Mutation>& all) {
  const Timed kTimed[] = {
      {"hill", "rate/tumble", {"rate_nees_flight"}, {"rate_nees_flight", "rate_nees_impact"}, {"rate_time_offset_s"}},
      {"hill", "rate/tumble_lag", {"rate_nees_flight"}, {"rate_nees_flight"}, {"rate_time_offset_s"}},
      {"swing", "rate/tumble", {"rate_nees_flight"}, {"rate_nees_flight"}, {"rate_time_offset_s"}},
      {"bump", "attitude/tumble", {"inclination_nees_median"}, {}, {}},
      {"swing",
       "attitude/tumble",
       {"inclination_nees_median"},
       {"inclination_nees_median"},
       {"attitude_time_offset_s"}},
      {"bump",
       "position/tumble",
       {"position_nees_median"},
       {"position_nees_median"},
       {"pose_time_offset_s", "ate_rad", "rpe_1m_rad"}},
      {"bump", "position/tumble_lag", {"position_nees_median"}, {}, {"pose_time_offset_s"}},
      {"bump", "position/tumble_live", {"position_nees_median"}, {}, {"pose_time_offset_s"}},
      {"roll", "position/tumble", {"position_nees_median"}, {"position_nees_median"}, {"pose_time_offset_s"}},
      {"hill", "slam/tumble", {"pose_nees"}, {"pose_nees"}, {"pose_time_offset_s"}},
      {"hill", "slam/tumble_lag", {"pose_nees"}, {"pose_nees"}, {"pose_time_offset_s"}},
      {"hill", "slam/tumble_live", {"pose_nees"}, {"pose_nees"}, {"pose_time_offset_s"}},
  };
  for (const Timed& one : kTimed) {
    if (!one.halved.empty())
      all.push_back({"covariance_halved", one.scenario, one.method, one.halved, nullptr, halve_covariances});
    if (!one.doubled.empty())
      all.push_back({"covariance_doubled", one.scenario, one.method, one.doubled, nullptr, double_covariances});
    if (!one.shifted.empty())
      all.push_back({"shift_1_ms", one.scenario, one.method, one.shifted, nullptr, shift_by_1_ms});
  }
}

/// Returns the wrong sign of the lever arm in the input of methods of kind `rate`.
void add_wrong_inputs(std::vector<Mutation>& all) {
  all.push_back({"lever_arm_sign_given",
                 "hill",
                 "rate/tumble",
                 {"rate_error_clipped_median_rad_s", "rate_error_free_median_rad_s", "rate_error_clipped_p99_rad_s",
                  "rate_coverage_3sigma"},
                 flip_lever_arms,
                 nullptr});
  all.push_back({"lever_arm_sign_given",
                 "hill",
                 "rate/tumble_lag",
                 {"rate_error_clipped_median_rad_s"},
                 flip_lever_arms,
                 nullptr});
}

/// A Changed contains a fault of the returned estimate, and the metrics that must detect the fault.
struct Changed {
  std::string name, scenario, method;
  void (*returned)(const sim::Recording&, Estimate&);
  std::vector<std::string> metrics;
};

void add_changed(std::vector<Mutation>& all) {
  const Changed kChanged[] = {
      {"lever_arm_sign_of_poses",
       "hill",
       "slam/tumble",
       flip_lever_arm_of_poses,
       {"ate_m", "translation_error_end_m", "rpe_1m_m", "map_error_mean_m", "map_overlap"}},
      {"half_map", "hill", "slam/tumble", lose_half_the_map, {"map_coverage"}},
      {"broken_border", "hill", "slam/tumble", break_sweep_borders, {"sweep_jump_m_s"}},
      {"turned_end", "hill", "slam/tumble", turn_the_end, {"rotation_error_end_rad"}},
      {"map_elsewhere", "hill", "slam/tumble", move_the_map, {"map_failed"}},
      {"map_twice", "hill", "slam/tumble", draw_map_twice, {"map_unique_share"}},
      {"map_twice", "hill", "slam/tumble_lag", draw_map_twice, {"map_unique_share"}},
      {"map_twice_turned", "hill", "slam/tumble", draw_map_twice_turned, {"map_overlap_0_10"}},
      {"lost_bump", "bump", "position/tumble", lose_a_bump, {"position_end_error_share", "position_coverage_3sigma"}},
      {"lost_bump", "bump", "position/tumble_live", lose_a_bump, {"position_end_error_share"}},
      {"sunk", "bump", "position/tumble", sink_poses, {"position_height_error_max_m"}},
      {"tilted", "bump", "attitude/tumble", tilt_attitudes, {"inclination_rmse_rad", "inclination_coverage_3sigma"}},
      {"turning", "bump", "attitude/tumble", turn_attitudes, {"heading_rmse_rad"}},
      {"lost_slip", "slip", "position/tumble", lose_slips, {"slip_recall"}},
      {"lost_slip", "slip", "position/tumble_lag", lose_slips, {"slip_recall"}},
      {"lost_slip", "slip", "position/tumble_live", lose_slips, {"slip_recall"}},
      {"early_slip", "slip", "position/tumble", claim_slips_early, {"slip_precision"}},
      {"early_slip", "slip", "position/tumble_live", claim_slips_early, {"slip_precision"}},
  };
  for (const Changed& one : kChanged)
    all.push_back({one.name, one.scenario, one.method, one.metrics, nullptr, one.returned});
}

}  // namespace

std::span<const Mutation> mutations() {
  static const std::vector<Mutation> kAll = [] {
    std::vector<Mutation> all;
    add_timed(all);
    add_wrong_inputs(all);
    add_changed(all);
    return all;
  }();
  return kAll;
}

}  // namespace tumble::scenarios::testing
