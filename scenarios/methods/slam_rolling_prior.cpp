// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/position_stage.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/sample_times.hpp"
#include "scenarios/methods/slam_settings.hpp"
#include "scenarios/methods/sphere_attitude.hpp"
#include "tumble/common/so3.hpp"

/// Builds maps of a rolling sphere with the rig's registration and rolling odometry as the prior.
namespace tumble::scenarios {

namespace {

// Uncertainty of a sweep's start relative to the last sweep's end, over 0.1 s. The velocity's uncertainty is added.
constexpr double kPriorSigmaM = 1e-4, kPriorSigmaRad = 2e-5, kPriorSigmaMS = 1e-4, kForceSigmaShare = 2e-3;

/// Returns the chain's parameters with a tight prior from rolling, because consecutive sweeps see new, unmapped areas.
const Settings<SlamParams>& prior_settings() {
  static const Settings<SlamParams> all = [] {
    SlamParams params;
    params.odometry.expert.prior.sigma_m = kPriorSigmaM;
    params.odometry.expert.prior.sigma_rad = kPriorSigmaRad;
    params.odometry.expert.prior.sigma_m_s = kPriorSigmaMS;
    params.odometry.expert.prior.force_share = kForceSigmaShare;
    // The fixed parameters belong to the generated samples.
    return slam_settings(params, {"gravity_m_s2", "correction_max_m", "correction_max_rad"});
  }();
  return all;
}

/// Parameters of the velocity prior from rolling.
struct AlongParams {
  double gravity_m_s2 = 1.2;
  double grip_sigma_share = 4e-3, still_sigma_m_s = 3e-4, loose_sigma_share = 0.1, loose_sigma_m_s = 0.03;
  double moving_m_s = 0.03;
  double correction_m = 0.03, correction_rad = 0.015, loose_correction_m = 0.1;
  double segment_m = 0.5, segment_sigma_m = 3e-3;
  double corrected_sigmas = 4.0, corrected_share = 0.01;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.gravity_m_s2, {"along_gravity_m_s2", "m/s^2", 0.1, 20.0,
                           "gravity in the accelerometer readings that are computed along the rolled poses; large "
                           "enough for levelling, small enough that attitude corrections cause no false acceleration"});
    visit(p.grip_sigma_share,
          {"along_grip_sigma_share", "1", 1e-6, 1.0,
           "standard deviation of the rolling velocity while gripping, as a share of it (scale error)"});
    visit(p.still_sigma_m_s, {"along_still_sigma_m_s", "m/s", 1e-9, 10.0,
                              "least standard deviation of the rolling velocity, and its value at rest"});
    visit(p.loose_sigma_share,
          {"along_loose_sigma_share", "1", 1e-6, 10.0,
           "standard deviation of the velocity during an event or while the radius is uncertain, as a share of it"});
    visit(p.loose_sigma_m_s, {"along_loose_sigma_m_s", "m/s", 1e-9, 10.0,
                              "least standard deviation of the velocity in that case while moving"});
    visit(p.moving_m_s, {"along_moving_m_s", "m/s", 1e-6, 10.0, "speed from which the sphere counts as moving"});
    visit(p.correction_m,
          {"along_correction_m", "m", 1e-6, 100.0,
           "largest accepted position correction by registration; the rolling error per sweep is below 1 mm"});
    visit(p.correction_rad,
          {"along_correction_rad", "rad", 1e-6, 3.0, "largest accepted rotation correction by registration"});
    visit(p.loose_correction_m, {"along_loose_correction_m", "m", 0.0, 100.0,
                                 "additional accepted position correction while the radius is uncertain"});
    visit(p.segment_m,
          {"along_segment_m", "m", 0.01, 100.0, "length of the rolled path over which the lidar measures the radius"});
    visit(p.segment_sigma_m, {"along_segment_sigma_m", "m", 1e-6, 10.0,
                              "least standard deviation of this length, from the centre and the registration"});
    visit(p.corrected_sigmas,
          {"along_corrected_sigmas", "1", 0.0, 1e3,
           "difference between the lidar's and the stated radius, in standard deviations, above which "
           "the lidar's radius is used"});
    visit(p.corrected_share, {"along_corrected_share", "1", 0.0, 1.0,
                              "least difference between the lidar's and the stated radius, as a share, above which the "
                              "lidar's radius is used"});
  }
};

const Settings<AlongParams>& along_settings() {
  static const Settings<AlongParams> all(AlongParams{});
  return all;
}

/// Position method whose poses are the prior of the registration.
const Method& followed() {
  static const Method method = position_tumble();
  return method;
}

/// Generates IMU readings along the poses of the position method, with little gravity. The mapper integrates the
/// generated readings within a sweep, and thus the rolling odometry is its prior.
std::vector<ImuSample> samples_along(const Estimate& poses, const sim::Sensors& sensors, std::span<const ImuSample> raw,
                                     double gravity_m_s2) {
  const Eigen::Isometry3d& T_BI = sensors.imus.front().T_BI;
  const Eigen::Vector3d arm_B = T_BI.translation() - poses.centre_B_m;  // from the centre
  const Eigen::Vector3d gravity_W(0.0, 0.0, gravity_m_s2);
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

struct Radius {
  double m = 0.0, sigma_m = 0.0;
};

/// Estimates the radius at which the rolled distance equals the distance of the registered sweeps, over segments with
/// continuous contact. Returns empty if there are too few segments.
std::optional<Radius> radius_by_lidar(const Estimate& rolled, const Estimate& registered, const sim::Sensors& sensors,
                                      double radius_m, const AlongParams& params) {
  const Eigen::Isometry3d T_IG =
      sensors.imus.front().T_BI.inverse(Eigen::Isometry) * Eigen::Translation3d(rolled.centre_B_m);
  double squares = 0.0, products = 0.0;
  std::vector<Eigen::Vector2d> segments;  // rolled and registered distance
  bool open = false;                      // a segment has started
  Eigen::Vector3d from_rolled = Eigen::Vector3d::Zero(), from_registered = Eigen::Vector3d::Zero();
  std::size_t k = 0;
  for (const LidarInertialOdometry::SweepReport& sweep : registered.sweeps) {
    for (; k + 1 < rolled.poses.size() && rolled.poses[k].time_ns < sweep.pose.time_ns; ++k) {
      if (rolled.contacts[k] != sim::ContactLabel::grip) open = false;
    }
    if (sweep.verdict != SweepVerdict::registered) continue;  // a predicted pose is no independent measurement
    const Eigen::Vector3d p_rolled = rolled.poses[k].p_WA_m;
    const Eigen::Vector3d p_registered =
        (Eigen::Translation3d(sweep.pose.p_WA_m) * sweep.pose.q_WA * T_IG).translation();
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

/// Estimates poses of a rolling sphere of `radius_m` without the lidar.
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

/// Returns the velocity of the primary IMU along the poses. `loosely` increases the uncertainty to allow for an
/// uncertain radius.
KnownMotion motion_of(const Estimate& rolled, std::span<const ImuSample> samples, const sim::Sensors& sensors,
                      const AlongParams& params, bool loosely) {
  const Eigen::Isometry3d& T_BI = sensors.imus.front().T_BI;
  const Eigen::Vector3d arm_I = T_BI.linear().transpose() * (T_BI.translation() - rolled.centre_B_m);
  KnownMotion motion;
  motion.gravity_m_s2 = params.gravity_m_s2;
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
    velocity.sigma_m_s =
        params.still_sigma_m_s + (loose ? params.loose_sigma_share : params.grip_sigma_share) * speed_m_s;
    if (loose && speed_m_s > params.moving_m_s)
      velocity.sigma_m_s = std::max(velocity.sigma_m_s, params.loose_sigma_m_s);
  }
  const double lost_m = std::ranges::any_of(rolled.uncertain, std::identity()) ? 3.0 * std::sqrt(variance_m2) : 0.0;
  motion.correction_max_m = params.correction_m + (loosely ? params.loose_correction_m : 0.0) + lost_m;
  motion.correction_max_rad = params.correction_rad;
  return motion;
}

/// Registers sweeps with the motion `rolled` as the prior between two sweeps.
Estimate register_along(const Estimate& rolled, const sim::Sensors& sensors, std::span<const ImuSample> raw,
                        const sim::Values& parameters, bool loosely) {
  Estimate estimate;
  estimate.frame = Frame::imu;
  estimate.status = rolled.status;
  if (!estimate.status.ok()) return estimate;
  const AlongParams params = along_settings().read(parameters);
  const std::vector<ImuSample> samples = samples_along(rolled, sensors, raw, params.gravity_m_s2);
  estimate.status = raw_rates(sensors, samples, estimate.rates);
  // The prior already contains the gyro noise.
  for (RateState& rate : estimate.rates) rate.covariance_rad2_s2.setZero();
  const KnownMotion motion = motion_of(rolled, samples, sensors, params, loosely);
  SlamChain chain;
  chain.along = &motion;
  if (estimate.status.ok()) run_slam_chain(sensors, samples, {prior_settings(), parameters}, chain, estimate);
  return estimate;
}

/// Runs the method twice: with a weak prior to estimate the radius, then with a tight prior and the estimated radius.
Estimate run_rolling_prior(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  estimate.frame = Frame::imu;
  std::vector<ImuSample> raw;
  estimate.status = bridge::primary_imu_samples(sensors, raw);
  if (!estimate.status.ok()) return estimate;
  require_sphere("slam/rolling_prior", sensors);
  const AlongParams params = along_settings().read(parameters);
  const double radius_m = parameters.has(kRadius) ? parameters.at(kRadius) : sensors.sphere_radius_m;
  Estimate rolled = roll(sensors, parameters, radius_m);
  estimate = register_along(rolled, sensors, raw, parameters, true);
  if (!estimate.status.ok()) return estimate;
  const std::optional<Radius> radius = radius_by_lidar(rolled, estimate, sensors, radius_m, params);
  const double off_m = radius ? std::abs(radius->m - radius_m) : 0.0;
  const bool corrected = radius && radius->m > 0.0 &&
                         off_m > std::max(params.corrected_sigmas * radius->sigma_m, params.corrected_share * radius_m);
  if (corrected) rolled = roll(sensors, parameters, radius->m);
  estimate = register_along(rolled, sensors, raw, parameters, false);
  if (corrected) estimate.health["radius_mended"] = 1.0;
  if (radius) {
    estimate.health["radius_m"] = radius->m;
    estimate.health["radius_sigma_m"] = radius->sigma_m;
  }
  return estimate;
}

}  // namespace

Method slam_rolling_prior() {
  MethodInfo info;
  info.name = "rolling_prior";
  info.kind = Kind::slam;
  info.doc = "Rig registration with the poses of our position method as the prior between two sweeps.";
  info.ours = true;
  info.settings = stages_after({&prior_settings(), &along_settings()}, followed());
  info.robots = {"sphere"};
  return make_method(std::move(info), at_sample_times<run_rolling_prior>);
}

}  // namespace tumble::scenarios
