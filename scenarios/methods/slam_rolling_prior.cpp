// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/rate_baselines.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/sample_times.hpp"
#include "scenarios/methods/slam_chain.hpp"
#include "scenarios/methods/sphere_imus.hpp"

namespace tumble::scenarios {

namespace {

const Settings<SlamParams>& prior_settings() {
  static const Settings<SlamParams> all = slam_settings({}, {"gravity_m_s2", "correction_max_m", "correction_max_rad"});
  return all;
}

struct AlongParams {
  double grip_sigma_ratio = 4e-3, still_sigma_m_s = 3e-4, loose_sigma_share = 0.1, loose_sigma_m_s = 0.03;
  double rotation_sigma_rad = 2e-4;
  double moving_m_s = 0.03;
  double correction_m = 0.03, correction_rad = 0.015, loose_correction_m = 0.1;
  double segment_m = 0.5, segment_sigma_m = 3e-3;
  double corrected_sigmas = 4.0, corrected_share = 0.01;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.grip_sigma_ratio,
          {"along_grip_sigma_share", "1", 1e-6, 1.0,
           "standard deviation of the rolling velocity while the sphere grips, as a share of the speed"});
    visit(p.still_sigma_m_s,
          {"along_still_sigma_m_s", "m/s", 1e-9, 10.0,
           "standard deviation of the rolling velocity at rest; in motion, a share of the speed is added"});
    visit(p.loose_sigma_share, {"along_loose_sigma_share", "1", 1e-6, 10.0,
                                "standard deviation of the rolling velocity without grip, as a share of the speed; "
                                "also used before the lidar has measured the radius"});
    visit(p.loose_sigma_m_s, {"along_loose_sigma_m_s", "m/s", 1e-9, 10.0,
                              "minimum standard deviation of the velocity of a moving sphere without grip; also used "
                              "before the lidar has measured the radius"});
    visit(p.rotation_sigma_rad,
          {"along_rotation_sigma_rad", "rad", 1e-9, 1.0,
           "standard deviation of the rotation between the ends of two consecutive sweeps, per axis"});
    visit(p.moving_m_s, {"along_moving_m_s", "m/s", 1e-6, 10.0, "minimum speed at which the sphere counts as moving"});
    visit(p.correction_m, {"along_correction_m", "m", 1e-6, 100.0,
                           "registration rejects a sweep if the position correction exceeds this limit"});
    visit(p.correction_rad, {"along_correction_rad", "rad", 1e-6, 3.0,
                             "registration rejects a sweep if the rotation correction exceeds this limit"});
    visit(p.loose_correction_m, {"along_loose_correction_m", "m", 0.0, 100.0,
                                 "increase of along_correction_m before the lidar has measured the radius"});
    visit(p.segment_m, {"along_segment_m", "m", 0.01, 100.0,
                        "length of the rolled path over which the lidar measures the radius of the sphere"});
    visit(p.segment_sigma_m,
          {"along_segment_sigma_m", "m", 1e-6, 10.0,
           "minimum standard deviation of a path length measured by the lidar, to cover registration errors"});
    visit(p.corrected_sigmas, {"along_corrected_sigmas", "1", 0.0, 1e3,
                               "the lidar's radius replaces the stated radius only if both differ by more than this "
                               "number of standard deviations"});
    visit(p.corrected_share, {"along_corrected_share", "1", 0.0, 1.0,
                              "the lidar's radius replaces the stated radius only if both differ by more than this "
                              "share of the stated radius"});
  }
};

const Settings<AlongParams>& along_settings() {
  static const Settings<AlongParams> all(AlongParams{});
  return all;
}

const Method& followed() {
  static const Method method = position_tumble();
  return method;
}

struct Radius {
  double m = 0.0, sigma_m = 0.0;
};

/// Estimates the radius of the sphere, such that the rolled distance equals the distance between registered sweeps.
/// Only segments with continuous floor contact are used.
std::optional<Radius> radius_by_lidar(const Estimate& rolled, const Estimate& registered, const sim::Sensors& sensors,
                                      double radius_m, const AlongParams& params) {
  const Eigen::Isometry3d T_IG =
      sensors.imus.front().T_BI.inverse(Eigen::Isometry) * Eigen::Translation3d(rolled.centre_B_m);
  double squares = 0.0, products = 0.0;
  std::vector<Eigen::Vector2d> segments;  // rolled and registered distance
  bool open = false;                      // a segment has started
  Eigen::Vector3d from_rolled = Eigen::Vector3d::Zero(), from_registered = Eigen::Vector3d::Zero();
  std::size_t k = 0;
  for (const LidarInertialOdometry::SweepResult& sweep : registered.sweeps) {
    for (; k + 1 < rolled.poses.size() && rolled.poses[k].time_ns < sweep.pose.time_ns; ++k) {
      if (rolled.contacts[k] != sim::ContactLabel::grip) open = false;
    }
    if (sweep.verdict != SweepVerdict::registered) continue;  // no independent measurement
    const Eigen::Vector3d p_rolled = rolled.poses[k].position_W_m;
    const Eigen::Vector3d p_registered =
        (Eigen::Translation3d(sweep.pose.position_W_m) * sweep.pose.orientation_W * T_IG).translation();
    if (open && (p_rolled - from_rolled).norm() < params.segment_m) continue;
    if (open) {
      const Eigen::Vector2d segment((p_rolled - from_rolled).norm(), (p_registered - from_registered).norm());
      squares += segment.x() * segment.x();
      products += segment.x() * segment.y();
      segments.push_back(segment);
    }
    open = true;
    from_rolled = p_rolled;
    from_registered = p_registered;
  }
  if (segments.size() < 2) return std::nullopt;
  const double ratio = products / squares;
  double residuals = 0.0;
  for (const Eigen::Vector2d& segment : segments) {
    residuals += (segment.y() - ratio * segment.x()) * (segment.y() - ratio * segment.x());
  }
  const double scatter_m = std::sqrt(residuals / static_cast<double>(segments.size() - 1));
  return Radius{radius_m * ratio, radius_m * std::max(scatter_m, params.segment_sigma_m) / std::sqrt(squares)};
}

constexpr const char* kRadius = "radius_m";

Estimate roll(const sim::Sensors& sensors, const sim::Values& parameters, double radius_m) {
  sim::Sensors own;
  own.robot = sensors.robot;
  own.gravity_m_s2 = sensors.gravity_m_s2;
  own.imus = sensors.imus;
  own.sphere_radius_m = radius_m;
  sim::Values values = values_of(followed(), parameters);
  values.set(kRadius, radius_m);
  return followed().run(own, values, {});
}

class RolledMotion {
 public:
  RolledMotion(const Estimate& rolled, const sim::Sensors& sensors, const AlongParams& params, bool loosely)
      : rolled_(rolled),
        T_GI_(Eigen::Translation3d(-rolled.centre_B_m) * sensors.imus.front().T_BI),
        params_(params),
        loosely_(loosely) {}

  std::optional<RelativePoseReading> between(TimeNs from_ns, TimeNs to_ns) const {
    const std::vector<PoseState>& poses = rolled_.poses;
    if (poses.empty() || from_ns < poses.front().time_ns || to_ns > poses.back().time_ns || from_ns >= to_ns) return {};
    RelativePoseReading motion;
    motion.from_ns = from_ns;
    motion.to_ns = to_ns;
    motion.imu_T_from_to = pose_of_imu(from_ns).inverse(Eigen::Isometry) * pose_of_imu(to_ns);
    const double sigma_m = velocity_sigma_m_s(from_ns, to_ns) * seconds(to_ns - from_ns);
    motion.covariance.diagonal().head<3>().setConstant(sigma_m * sigma_m);
    motion.covariance.diagonal().tail<3>().setConstant(params_.rotation_sigma_rad * params_.rotation_sigma_rad);
    return motion;
  }

 private:
  std::size_t index_at(TimeNs time_ns) const {
    const auto found = std::lower_bound(rolled_.poses.begin(), rolled_.poses.end(), time_ns,
                                        [](const PoseState& pose, TimeNs t) { return pose.time_ns < t; });
    return static_cast<std::size_t>(found - rolled_.poses.begin());
  }

  Eigen::Isometry3d pose_of_imu(TimeNs time_ns) const {
    const std::size_t k = index_at(time_ns);
    const PoseState& after = rolled_.poses[k];
    const PoseState& before = rolled_.poses[k > 0 ? k - 1 : 0];
    const double share = after.time_ns > before.time_ns
                             ? seconds(time_ns - before.time_ns) / seconds(after.time_ns - before.time_ns)
                             : 0.0;
    const Eigen::Vector3d p = (1.0 - share) * before.position_W_m + share * after.position_W_m;
    return Eigen::Translation3d(p) * before.orientation_W.slerp(share, after.orientation_W) * T_GI_;
  }

  double velocity_sigma_m_s(TimeNs from_ns, TimeNs to_ns) const {
    double largest_m_s = 0.0;
    for (std::size_t k = index_at(from_ns); k < rolled_.poses.size() && rolled_.poses[k].time_ns <= to_ns; ++k) {
      const double speed_m_s = rolled_.poses[k].velocity_W_m_s.norm();
      const bool loose = loosely_ || rolled_.contacts[k] != sim::ContactLabel::grip;
      double sigma_m_s =
          params_.still_sigma_m_s + (loose ? params_.loose_sigma_share : params_.grip_sigma_ratio) * speed_m_s;
      if (loose && speed_m_s > params_.moving_m_s) sigma_m_s = std::max(sigma_m_s, params_.loose_sigma_m_s);
      largest_m_s = std::max(largest_m_s, sigma_m_s);
    }
    return std::max(largest_m_s, params_.still_sigma_m_s);
  }

  const Estimate& rolled_;
  Eigen::Isometry3d T_GI_;
  const AlongParams& params_;
  bool loosely_;
};

double correction_max_m(const Estimate& rolled, const AlongParams& params, bool loosely) {
  double variance_m2 = 0.0;
  for (const PoseState& pose : rolled.poses)
    variance_m2 = std::max(variance_m2, pose.covariance.topLeftCorner<3, 3>().trace());
  const double lost_m = std::ranges::any_of(rolled.uncertain, std::identity()) ? 3.0 * std::sqrt(variance_m2) : 0.0;
  return params.correction_m + (loosely ? params.loose_correction_m : 0.0) + lost_m;
}

Estimate register_along(const Estimate& rolled, const sim::Sensors& sensors, std::span<const ImuSample> samples,
                        const sim::Values& parameters, bool loosely) {
  Estimate estimate;
  estimate.frame = Frame::imu;
  estimate.status = rolled.status;
  if (!estimate.status.ok()) return estimate;
  const AlongParams params = along_settings().read(parameters);
  estimate.status = raw_rates(sensors, samples, estimate.rates);
  const RolledMotion rolling(rolled, sensors, params, loosely);
  const KnownMotion motion{[&](TimeNs from_ns, TimeNs to_ns) { return rolling.between(from_ns, to_ns); },
                           correction_max_m(rolled, params, loosely), params.correction_rad};
  SlamChain chain;
  chain.along = &motion;
  if (estimate.status.ok()) run_slam_chain(sensors, samples, {prior_settings(), parameters}, chain, estimate);
  return estimate;
}

Estimate run_rolling_prior(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  estimate.frame = Frame::imu;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;
  require_sphere("slam/rolling_prior", sensors);
  const AlongParams params = along_settings().read(parameters);
  const double radius_m = parameters.has(kRadius) ? parameters.at(kRadius) : sensors.sphere_radius_m;
  Estimate rolled = roll(sensors, parameters, radius_m);
  estimate = register_along(rolled, sensors, samples, parameters, true);
  if (!estimate.status.ok()) return estimate;
  const std::optional<Radius> radius = radius_by_lidar(rolled, estimate, sensors, radius_m, params);
  const double off_m = radius ? std::abs(radius->m - radius_m) : 0.0;
  const bool corrected = radius && radius->m > 0.0 &&
                         off_m > std::max(params.corrected_sigmas * radius->sigma_m, params.corrected_share * radius_m);
  if (corrected) rolled = roll(sensors, parameters, radius->m);
  estimate = register_along(rolled, sensors, samples, parameters, false);
  if (corrected) estimate.health["radius_corrected"] = 1.0;
  if (radius) {
    estimate.health["radius_m"] = radius->m;
    estimate.health["radius_sigma_m"] = radius->sigma_m;
  }
  return estimate;
}

}  // namespace

Method slam_rolling_prior() {
  return make_method({.name = "rolling_prior",
                      .kind = Kind::slam,
                      .doc = "Registers the lidar sweeps of a sphere. The poses of position/tumble (our method) "
                             "predict the motion between two sweeps. The registration algorithm is also used for rigs.",
                      .ours = true,
                      .settings = stages_after({&prior_settings(), &along_settings()}, followed()),
                      .robots = {"sphere"}},
                     at_sample_times<run_rolling_prior>);
}

}  // namespace tumble::scenarios
