// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/synthetic_recording.hpp"

#include "tests/testing.hpp"

namespace tumble::scenarios::testing {

namespace {

constexpr double kGravity = 9.80665;
constexpr std::int64_t kImuPeriodNs = 5000000;
constexpr std::int64_t kTruthPeriodNs = 500000;
constexpr std::int64_t kSweepPeriodNs = 100000000;
constexpr int kRings = 16;
constexpr int kColumns = 150;
constexpr double kSphereRadiusM = 0.145;

void add_truth(const SyntheticMotion& motion, sim::Recording& recording) {
  sim::Truth& truth = recording.truth;
  truth.period_ns = kTruthPeriodNs;
  const auto count = static_cast<std::int64_t>(std::llround(motion.duration_s * 1e9)) / kTruthPeriodNs + 1;
  for (std::int64_t k = 0; k < count; ++k) {
    const double t = 1e-9 * static_cast<double>(k * kTruthPeriodNs);
    truth.p_WB_m.push_back(motion.position_m(t));
    truth.q_WB.push_back(motion.attitude(t));
    truth.v_WB_m_s.push_back(motion.velocity_m_s(t));
    truth.w_WB_B_rad_s.push_back(motion.rate_B_rad_s(t));
    truth.f_B_m_s2.push_back(motion.specific_force_B_m_s2(t, Eigen::Vector3d::Zero()));
    truth.label.push_back(sim::ContactLabel::air);
  }
}

void add_imu(const SyntheticMotion& motion, const Isometry3d& T_BI, sim::Recording& recording) {
  sim::ImuRecord record;
  record.name = "imu";
  record.device = "synthetic";
  record.period_ns = kImuPeriodNs;
  record.stated_gyro_range_rad_s = motion.rail_rad_s;
  record.stated_accel_range_m_s2 = 1000.0;
  record.gyro_noise_rad_s_sqrt_hz = 1e-4;
  record.T_BI = T_BI;
  sim::ImuTruth truth;
  truth.name = "imu";
  truth.T_BI = T_BI;
  const Matrix3d R_IB = T_BI.linear().transpose();
  const auto count = static_cast<std::int64_t>(std::llround(motion.duration_s * 1e9)) / kImuPeriodNs;
  for (std::int64_t k = 1; k <= count; ++k) {
    const double middle_s = 1e-9 * (static_cast<double>(k) - 0.5) * static_cast<double>(kImuPeriodNs);
    const Vector3d rate = R_IB * motion.rate_B_rad_s(middle_s);
    const Vector3d force = R_IB * motion.specific_force_B_m_s2(middle_s, T_BI.translation());
    record.time_ns.push_back(k * kImuPeriodNs);
    record.gyro_rad_s.push_back(rate.cwiseMax(-motion.rail_rad_s).cwiseMin(motion.rail_rad_s));
    record.accel_m_s2.push_back(force);
    record.clip_flags.push_back(0);
    truth.rate_rad_s.push_back(rate);
    truth.specific_force_m_s2.push_back(force);
    truth.gyro_unclipped_rad_s.push_back(rate);
    truth.accel_unclipped_m_s2.push_back(force);
    truth.gyro_bias_rad_s.push_back(Eigen::Vector3d::Zero());
    truth.accel_bias_m_s2.push_back(Eigen::Vector3d::Zero());
  }
  recording.sensors.imus.push_back(record);
  recording.truth.imus.push_back(truth);
}

// returns the distance to the room from inside along a unit direction; it is negative when the ray leaves through the
// open top
double range_in_room(const Vector3d& from, const Vector3d& direction) {
  double range = 1e9;
  if (direction.z() < 0.0) range = -from.z() / direction.z();
  for (int j = 0; j < 2; ++j) {
    if (direction[j] != 0.0)
      range = std::min(range, (std::copysign(kRoomHalfM, direction[j]) - from[j]) / direction[j]);
  }
  return from.z() + range * direction.z() > kRoomHeightM ? -1.0 : range;
}

void add_lidar(const SyntheticMotion& motion, const Isometry3d& T_BL, sim::Recording& recording) {
  sim::LidarRecord record;
  record.name = "lidar";
  record.device = "synthetic";
  record.T_BL = T_BL;
  record.sweep_period_ns = kSweepPeriodNs;
  sim::LidarTruth truth;
  truth.name = "lidar";
  truth.T_BL = T_BL;
  const auto sweeps = static_cast<std::int64_t>(std::llround(motion.duration_s * 1e9)) / kSweepPeriodNs;
  for (std::int64_t sweep = 0; sweep < sweeps; ++sweep) {
    record.sweep_start_ns.push_back(sweep * kSweepPeriodNs);
    record.sweep_first.push_back(record.position_L_m.size());
    for (int column = 0; column < kColumns; ++column) {
      const std::int64_t offset_ns = column * (kSweepPeriodNs / kColumns);
      const double t = 1e-9 * static_cast<double>(sweep * kSweepPeriodNs + offset_ns);
      const Isometry3d T_WL = Eigen::Translation3d(motion.position_m(t)) * motion.attitude(t) * T_BL;
      const double azimuth = -2.0 * std::numbers::pi * column / kColumns;
      for (int ring = 0; ring < kRings; ++ring) {
        const double elevation = (-15.0 + 2.0 * ring) * std::numbers::pi / 180.0;
        const Vector3d ray_L(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                             std::sin(elevation));
        const double range = range_in_room(T_WL.translation(), T_WL.linear() * ray_L);
        if (range < 0.0) continue;
        record.position_L_m.push_back((range * ray_L).cast<float>());
        record.range_m.push_back(static_cast<float>(range));
        record.intensity.push_back(0.5f);
        record.offset_ns.push_back(static_cast<std::uint32_t>(offset_ns));
        record.ring.push_back(static_cast<std::uint16_t>(ring));
        truth.hit_W_m.push_back((T_WL * (range * ray_L)).cast<float>());
        truth.surface_id.push_back(0);
      }
    }
  }
  record.sweep_first.push_back(record.position_L_m.size());
  recording.sensors.lidars.push_back(record);
  recording.truth.lidars.push_back(truth);
  recording.truth.surfaces = {"room"};
}

}  // namespace

double SyntheticMotion::phase(double time_s) const {
  const double u = std::clamp((time_s - start_s) / (end_s - start_s), 0.0, 1.0);
  return u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
}

double SyntheticMotion::phase_rate(double time_s) const {
  const double u = std::clamp((time_s - start_s) / (end_s - start_s), 0.0, 1.0);
  return 30.0 * u * u * (1.0 - u) * (1.0 - u) / (end_s - start_s);
}

double SyntheticMotion::phase_acceleration(double time_s) const {
  const double length_s = end_s - start_s;
  const double u = std::clamp((time_s - start_s) / length_s, 0.0, 1.0);
  return 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) / (length_s * length_s);
}

Vector3d SyntheticMotion::position_m(double time_s) const {
  return start_m + phase(time_s) * displacement_m;
}

Quaterniond SyntheticMotion::attitude(double time_s) const {
  return Eigen::AngleAxisd(angle_rad * phase(time_s), axis_W) * q_start;
}

Vector3d SyntheticMotion::velocity_m_s(double time_s) const {
  return phase_rate(time_s) * displacement_m;
}

Vector3d SyntheticMotion::rate_B_rad_s(double time_s) const {
  return q_start.conjugate() * (angle_rad * phase_rate(time_s) * axis_W);
}

Vector3d SyntheticMotion::specific_force_B_m_s2(double time_s, const Vector3d& p_B_m) const {
  const Vector3d w = rate_B_rad_s(time_s);
  const Vector3d alpha = q_start.conjugate() * (angle_rad * phase_acceleration(time_s) * axis_W);
  const Vector3d of_centre_W = phase_acceleration(time_s) * displacement_m + kGravity * Eigen::Vector3d::UnitZ();
  return attitude(time_s).conjugate() * of_centre_W + alpha.cross(p_B_m) + w.cross(w.cross(p_B_m));
}

sim::Recording synthetic_rig(const SyntheticMotion& motion) {
  sim::Recording recording;
  recording.sensors.robot = "rig";
  Isometry3d T_BI = Eigen::Isometry3d::Identity();
  T_BI.linear() = Eigen::AngleAxisd(0.4, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  T_BI.translation() = Vector3d(-0.02, -0.08, 0.05);
  Isometry3d T_BL = Eigen::Isometry3d::Identity();
  T_BL.linear() = Eigen::AngleAxisd(-1.5, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T_BL.translation() = Vector3d(0.01, 0.02, 0.1);
  add_truth(motion, recording);
  add_imu(motion, T_BI, recording);
  add_lidar(motion, T_BL, recording);
  return recording;
}

sim::Recording synthetic_sphere(double distance_m, double direction_rad) {
  SyntheticMotion motion;
  const Vector3d direction(std::cos(direction_rad), std::sin(direction_rad), 0.0);
  // rolling gives v = r w x z, so that w = z x v / r
  motion.axis_W = Eigen::Vector3d::UnitZ().cross(direction);
  motion.angle_rad = distance_m / kSphereRadiusM;
  motion.displacement_m = distance_m * direction;
  motion.start_m = {0.3, -0.2, kSphereRadiusM};
  motion.rail_rad_s = 100.0;
  sim::Recording recording;
  recording.sensors.robot = "sphere";
  recording.sensors.sphere_radius_m = kSphereRadiusM;
  Isometry3d T_BI = Eigen::Isometry3d::Identity();
  T_BI.linear() = Eigen::AngleAxisd(1.2, Vector3d(-1, 1, 0.5).normalized()).toRotationMatrix();
  T_BI.translation() = Vector3d(0.03, 0.01, -0.02);
  add_truth(motion, recording);
  add_imu(motion, T_BI, recording);
  add_lidar(motion, Eigen::Isometry3d::Identity(), recording);
  return recording;
}

}  // namespace tumble::scenarios::testing
