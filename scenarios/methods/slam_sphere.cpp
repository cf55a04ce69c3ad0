// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/slam_settings.hpp"
#include "scenarios/methods/sphere_attitude.hpp"
#include "tumble/common/so3.hpp"
#include "tumble/mapping/voxel_map.hpp"

/// Maps of the rolling sphere: from the poses of a position method, as published, and by the registration of the rig
/// with rolling odometry as its prior.
namespace tumble::scenarios {

namespace {

constexpr double kNearestM = 0.3;  // nearer returns are the sphere's own

/// The map's numbers as those of a registration are called.
struct MapParams {
  VoxelMap::Params map;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("map_", p.map);
  }
};

const Settings<MapParams>& map_settings() {
  static const Settings<MapParams> all(MapParams{}, {.first = {"map_voxel_m", "map_spacing_m"}});
  return all;
}

// Of the sweep's start by the last one's end, over 0.1 s, beside what the velocity is off by.
constexpr double kPriorSigmaM = 1e-4, kPriorSigmaRad = 2e-5, kPriorSigmaMS = 1e-4, kForceSigmaShare = 2e-3;

/// Those of the chain, with a prior as tight as rolling makes it: sweep after sweep looks where no map is yet.
const Settings<SlamParams>& prior_settings() {
  static const Settings<SlamParams> all = [] {
    SlamParams params;
    params.odometry.expert.prior.sigma_m = kPriorSigmaM;
    params.odometry.expert.prior.sigma_rad = kPriorSigmaRad;
    params.odometry.expert.prior.sigma_m_s = kPriorSigmaMS;
    params.odometry.expert.prior.force_share = kForceSigmaShare;
    // of the samples that were made along the poses
    return slam_settings(params, {"gravity_m_s2", "correction_max_m", "correction_max_rad"});
  }();
  return all;
}

/// Runs the position method `name` with its defaults.
Estimate positions(const char* name, const sim::Sensors& sensors) {
  return find_methods(std::string("position/") + name).front()->run(sensors, {}, {});
}

/// Poses of the body in time order, asked for in time order too.
class Track {
 public:
  Track(const std::vector<PoseState>& poses, const Eigen::Vector3d& centre_B_m)
      : poses_(poses), centre_B_m_(centre_B_m) {}
  bool covers(std::int64_t time_ns) const {
    return !poses_.empty() && time_ns >= poses_.front().time_ns && time_ns <= poses_.back().time_ns;
  }
  /// Interpolated; O(1) for times near the last one asked for.
  Eigen::Isometry3d at(std::int64_t time_ns) {
    while (next_ > 1 && poses_[next_ - 1].time_ns > time_ns) --next_;
    while (next_ + 1 < poses_.size() && poses_[next_].time_ns < time_ns) ++next_;
    const PoseState &a = poses_[next_ - 1], &b = poses_[next_];
    const double share = seconds(time_ns - a.time_ns) / std::max(seconds(b.time_ns - a.time_ns), 1e-9);
    const Eigen::Vector3d p = a.p_WA_m + share * (b.p_WA_m - a.p_WA_m);
    return Eigen::Translation3d(p) * a.q_WA.slerp(share, b.q_WA) * Eigen::Translation3d(-centre_B_m_);
  }

 private:
  const std::vector<PoseState>& poses_;
  Eigen::Vector3d centre_B_m_;
  std::size_t next_ = 1;
};

// the lidar's place is known from the centre of mass, some mm from the centre; methods that do not say where take them
// for one
Estimate map_from_poses(const char* name, const sim::Sensors& sensors, const sim::Values& parameters) {
  Estimate estimate = positions(name, sensors);
  estimate.contacts.clear();
  estimate.uncertain.clear();
  if (!estimate.status.ok()) return estimate;
  if (sensors.lidars.empty() || estimate.poses.size() < 2) {
    estimate.status = {Trouble::empty, "lidars", 0.0, 1.0};
    return estimate;
  }
  const sim::LidarRecord& lidar = sensors.lidars.front();
  VoxelMap map(map_settings().read(parameters).map);
  Track track(estimate.poses, estimate.centre_B_m);
  std::size_t first_pose = 0;
  for (std::size_t k = 0; k < bridge::sweep_count(lidar); ++k) {
    const bridge::Sweep sweep = bridge::sweep(lidar, k);
    if (!track.covers(sweep.start_ns) || !track.covers(sweep.end_ns)) {
      estimate.health["sweeps_unfinished"] += 1.0;
      continue;
    }
    LidarInertialOdometry::SweepReport report;
    report.verdict = estimate.sweeps.empty() ? SweepVerdict::first : SweepVerdict::registered;
    for (const LidarPoint& point : sweep.points) {
      if (!point.position_L_m.allFinite() || point.position_L_m.norm() < kNearestM) continue;
      const Eigen::Isometry3d T_WL = track.at(sweep.start_ns + point.offset_ns) * lidar.T_BL;
      report.map_points_added +=
          map.insert((T_WL * point.position_L_m.cast<double>()).cast<float>(), 0.0f, static_cast<std::uint32_t>(k));
      ++report.points_used;
    }
    while (first_pose < estimate.poses.size() && estimate.poses[first_pose].time_ns < sweep.start_ns) ++first_pose;
    for (std::size_t j = first_pose; j < estimate.poses.size() && estimate.poses[j].time_ns <= sweep.end_ns; ++j) {
      report.trajectory.push_back(estimate.poses[j]);
    }
    report.pose = report.trajectory.empty() ? estimate.poses[first_pose] : report.trajectory.back();
    estimate.sweeps.push_back(std::move(report));
    estimate.sweep_end_ns.push_back(sweep.end_ns);
  }
  for (std::uint32_t index = 0; index < map.index_end(); ++index) {
    if (map.exists(index))
      estimate.map.push_back({map.position_W_m(index), Eigen::Vector3f::Zero(), map.sigma_m(index)});
  }
  return estimate;
}

Estimate run_poses_rolling(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return map_from_poses("rolling", sensors, parameters);
}
Estimate run_poses_autogain_fusion(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return map_from_poses("autogain_fusion", sensors, parameters);
}
Estimate run_poses_tumble(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return map_from_poses("tumble", sensors, parameters);
}

/// Enough to level by, and little: readings along a known motion are made from it, and gravity in them answers each
/// correction of the attitude with an acceleration that is not there.
constexpr double kHintOfGravityMS2 = 1.2;

/// Readings that an IMU would have had along the poses of the position method, in a world of little gravity: the
/// mapper, which integrates them within a sweep, then follows the rolling odometry.
std::vector<ImuSample> samples_along(const Estimate& poses, const sim::Sensors& sensors,
                                     std::span<const ImuSample> raw) {
  const Eigen::Isometry3d& T_BI = sensors.imus.front().T_BI;
  const Eigen::Vector3d arm_B = T_BI.translation() - poses.centre_B_m;  // from the centre
  const Eigen::Vector3d gravity_W(0.0, 0.0, kHintOfGravityMS2);
  std::vector<ImuSample> out(raw.begin(), raw.end());
  Eigen::Vector3d v_before = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < out.size(); ++k) {
    const PoseState& pose = poses.poses[k];
    const Eigen::Quaterniond q_WI = pose.q_WA * Eigen::Quaterniond(T_BI.linear());
    const double dt_s = k > 0 ? seconds(out[k].time_ns - out[k - 1].time_ns) : 0.0;
    if (k > 0) {
      const Eigen::Quaterniond q_before = poses.poses[k - 1].q_WA * Eigen::Quaterniond(T_BI.linear());
      out[k].angular_velocity_rad_s = so3::log(q_before.conjugate() * q_WI) / dt_s;
    } else {
      out[k].angular_velocity_rad_s.setZero();
    }
    const Eigen::Vector3d w_W = q_WI * out[k].angular_velocity_rad_s;
    const Eigen::Vector3d v = pose.v_WA_m_s + w_W.cross(pose.q_WA * arm_B);
    const Eigen::Vector3d a = k > 0 ? Eigen::Vector3d((v - v_before) / dt_s) : Eigen::Vector3d::Zero();
    const Eigen::Quaterniond q_mid = q_WI * so3::exp(-0.5 * dt_s * out[k].angular_velocity_rad_s);
    out[k].specific_force_m_s2 = q_mid.conjugate() * (a + gravity_W);
    out[k].device_clip_flags = 0;
    v_before = v;
  }
  return out;
}

constexpr double kStretchM = 0.5;        // of rolled way, over which the lidar measures the radius
constexpr double kStretchSigmaM = 3e-3;  // at the least: neither the centre nor the registration is better known
constexpr double kBeyondDoubt = 4.0;     // sigmas
constexpr double kMendedShare = 0.01;    // of the radius: registration has an error of scale of its own

struct Radius {
  double m = 0.0, sigma_m = 0.0;
};

/// The radius by which rolling goes as far as the registered sweeps do, over stretches on which the contact held. None
/// when there are too few.
std::optional<Radius> radius_by_lidar(const Estimate& rolled, const Estimate& registered, const sim::Sensors& sensors) {
  const Eigen::Isometry3d T_IG =
      sensors.imus.front().T_BI.inverse(Eigen::Isometry) * Eigen::Translation3d(rolled.centre_B_m);
  double squares = 0.0, products = 0.0;
  std::vector<Eigen::Vector2d> stretches;  // rolled, registered
  bool open = false;                       // a stretch has begun there:
  Eigen::Vector3d from_rolled = Eigen::Vector3d::Zero(), from_registered = Eigen::Vector3d::Zero();
  std::size_t k = 0;
  for (const LidarInertialOdometry::SweepReport& sweep : registered.sweeps) {
    for (; k + 1 < rolled.poses.size() && rolled.poses[k].time_ns < sweep.pose.time_ns; ++k) {
      if (rolled.contacts[k] != sim::ContactLabel::grip) open = false;
    }
    if (sweep.verdict != SweepVerdict::registered) continue;  // placed by inertia, which is the rolling itself
    const Eigen::Vector3d p_rolled = rolled.poses[k].p_WA_m;
    const Eigen::Vector3d p_registered =
        (Eigen::Translation3d(sweep.pose.p_WA_m) * sweep.pose.q_WA * T_IG).translation();
    if (open && (p_rolled - from_rolled).norm() < kStretchM) continue;
    if (open) {
      const Eigen::Vector2d stretch((p_rolled - from_rolled).norm(), (p_registered - from_registered).norm());
      squares += stretch.x() * stretch.x();
      products += stretch.x() * stretch.y();
      stretches.push_back(stretch);
    }
    open = true;
    from_rolled = p_rolled;
    from_registered = p_registered;
  }
  if (stretches.size() < 2) return std::nullopt;
  const double ratio = products / squares;
  double residuals = 0.0;
  for (const Eigen::Vector2d& stretch : stretches) {
    residuals += (stretch.y() - ratio * stretch.x()) * (stretch.y() - ratio * stretch.x());
  }
  const double scatter_m = std::sqrt(residuals / static_cast<double>(stretches.size() - 1));
  const double radius_m = sensors.sphere_radius_m;
  return Radius{radius_m * ratio, radius_m * std::max(scatter_m, kStretchSigmaM) / std::sqrt(squares)};
}

/// Poses by the rolling of a sphere of `radius_m`, without the lidar.
Estimate roll(const sim::Sensors& sensors, double radius_m) {
  sim::Sensors own;
  own.robot = sensors.robot;
  own.gravity_m_s2 = sensors.gravity_m_s2;
  own.imus = sensors.imus;
  own.sphere_radius_m = radius_m;
  return positions("tumble", own);
}

// Of the velocity by rolling: of scale while it grips, next to nothing at rest; in an event, and while the radius is in
// doubt, loose enough to go where the surfaces lead.
constexpr double kGripSigmaShare = 4e-3, kStillSigmaMS = 3e-4, kLooseSigmaMS = 0.03, kLooseSigmaShare = 0.1;
// A registration that asks for more than this is a false one: from sweep to sweep rolling errs by less than a
// millimetre. More where the radius is in doubt, and by three standard deviations where an event lost the way.
constexpr double kCorrectionMaxM = 0.03, kCorrectionMaxRad = 0.015, kLooseCorrectionM = 0.1;
constexpr double kMovingMS = 0.03;

/// What the poses say of the velocity of the primary IMU. `loosely`: of a radius that may be another.
KnownMotion motion_of(const Estimate& rolled, std::span<const ImuSample> samples, const sim::Sensors& sensors,
                      bool loosely) {
  const Eigen::Isometry3d& T_BI = sensors.imus.front().T_BI;
  const Eigen::Vector3d arm_I = T_BI.linear().transpose() * (T_BI.translation() - rolled.centre_B_m);
  KnownMotion motion;
  motion.gravity_m_s2 = kHintOfGravityMS2;
  double variance_m2 = 0.0;
  motion.velocities.resize(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const PoseState& pose = rolled.poses[k];
    variance_m2 = std::max(variance_m2, pose.covariance.topLeftCorner<3, 3>().trace());
    const Eigen::Quaterniond q_WI = pose.q_WA * Eigen::Quaterniond(T_BI.linear());
    const double speed_m_s = pose.v_WA_m_s.norm();
    KnownMotion::Velocity& velocity = motion.velocities[k];
    velocity.v_WI_I_m_s = q_WI.conjugate() * pose.v_WA_m_s + samples[k].angular_velocity_rad_s.cross(arm_I);
    const bool loose = loosely || rolled.contacts[k] != sim::ContactLabel::grip;
    velocity.sigma_m_s = kStillSigmaMS + (loose ? kLooseSigmaShare : kGripSigmaShare) * speed_m_s;
    if (loose && speed_m_s > kMovingMS) velocity.sigma_m_s = std::max(velocity.sigma_m_s, kLooseSigmaMS);
  }
  const double lost_m = std::ranges::any_of(rolled.uncertain, std::identity()) ? 3.0 * std::sqrt(variance_m2) : 0.0;
  motion.correction_max_m = kCorrectionMaxM + (loosely ? kLooseCorrectionM : 0.0) + lost_m;
  motion.correction_max_rad = kCorrectionMaxRad;
  return motion;
}

/// Registers with `rolled` as the prior between two sweeps.
Estimate register_along(const Estimate& rolled, const sim::Sensors& sensors, std::span<const ImuSample> raw,
                        const sim::Values& parameters, bool loosely) {
  Estimate estimate;
  estimate.frame = Frame::imu;
  estimate.status = rolled.status;
  if (!estimate.status.ok()) return estimate;
  const std::vector<ImuSample> samples = samples_along(rolled, sensors, raw);
  estimate.status = raw_rates(sensors, samples, estimate.rates);
  // what the gyro's noise did to the poses is in the prior
  for (RateState& rate : estimate.rates) rate.covariance_rad2_s2.setZero();
  const KnownMotion motion = motion_of(rolled, samples, sensors, loosely);
  SlamChain chain;
  chain.along = &motion;
  if (estimate.status.ok()) run_slam_chain(sensors, samples, {prior_settings(), parameters}, chain, estimate);
  return estimate;
}

/// Twice: loosely, which tells the radius, and then as tightly as rolling of that radius is sure.
Estimate run_rolling_prior(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  estimate.frame = Frame::imu;
  std::vector<ImuSample> raw;
  estimate.status = bridge::primary_imu_samples(sensors, raw);
  if (!estimate.status.ok()) return estimate;
  require_sphere("slam/rolling_prior", sensors);
  Estimate rolled = roll(sensors, sensors.sphere_radius_m);
  estimate = register_along(rolled, sensors, raw, parameters, true);
  if (!estimate.status.ok()) return estimate;
  const std::optional<Radius> radius = radius_by_lidar(rolled, estimate, sensors);
  const double off_m = radius ? std::abs(radius->m - sensors.sphere_radius_m) : 0.0;
  const bool mended = radius && radius->m > 0.0 &&
                      off_m > std::max(kBeyondDoubt * radius->sigma_m, kMendedShare * sensors.sphere_radius_m);
  if (mended) rolled = roll(sensors, radius->m);
  estimate = register_along(rolled, sensors, raw, parameters, false);
  if (mended) estimate.health["radius_mended"] = 1.0;
  if (radius) {
    estimate.health["radius_m"] = radius->m;
    estimate.health["radius_sigma_m"] = radius->sigma_m;
  }
  return estimate;
}

Method posed(const char* name, const char* doc, const char* source, RunCore run) {
  MethodInfo info;
  info.name = name;
  info.kind = Kind::slam;
  info.doc = doc;
  info.source = source;
  info.settings = {&map_settings()};
  info.robots = {"sphere"};
  return make_method(std::move(info), run);
}

}  // namespace

Method slam_poses_rolling() {
  return posed("poses_rolling", "A map from the poses of rolling; nothing is registered.",
               "textbook rolling constraint", run_poses_rolling);
}

Method slam_poses_autogain_fusion() {
  return posed("poses_autogain_fusion", "A map from the poses of autogain_fusion, as published; nothing is registered.",
               "Zevering et al., IMU-based pose-estimation for spherical robots, IEEE MFI 2021",
               run_poses_autogain_fusion);
}

Method slam_poses_tumble() {
  return posed("poses_tumble", "A map from the poses of our position method; nothing is registered.", "ours",
               run_poses_tumble);
}

Method slam_rolling_prior() {
  MethodInfo info;
  info.name = "rolling_prior";
  info.kind = Kind::slam;
  info.doc = "The registration of the rig, with the poses of our position method as its prior between two sweeps.";
  info.source = "ours";
  info.settings = {&prior_settings()};
  info.robots = {"sphere"};
  return make_method(std::move(info), run_rolling_prior);
}

}  // namespace tumble::scenarios
