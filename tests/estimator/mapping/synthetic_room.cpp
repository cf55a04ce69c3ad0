// SPDX-License-Identifier: BSD-3-Clause
#include "tests/estimator/mapping/synthetic_room.hpp"

#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble::test {

namespace {

constexpr int kRings = 16;

const Room::Plane kFloor{{0, 0, -1.5}, {0, 0, 1}};

/// Returns the integral from 0 of a smooth step from 0 to 1 over `rise` seconds.
double risen(double t, double rise) {
  if (t <= 0.0) return 0.0;
  if (t >= rise) return 0.5 * rise + (t - rise);
  const double x = t / rise;
  return rise * (x * x * x - 0.5 * x * x * x * x);
}

}  // namespace

Room Room::box() {
  return {{kFloor,
           {{0, 0, 6.5}, {0, 0, -1}},
           {{12, 0, 0}, {-1, 0, 0}},
           {{-12, 0, 0}, {1, 0, 0}},
           {{0, 9, 0}, {0, -1, 0}},
           {{0, -9, 0}, {0, 1, 0}}},
          {}};
}

Room Room::box_with_pillars() {
  Room room = box();
  room.pillars = {{{6, 5}, 0.4}, {{-5, 6}, 0.6}, {{-8, -4}, 0.5}, {{3, -6}, 0.3}, {{9, -2}, 0.7}, {{-3, -7}, 0.4}};
  return room;
}

Room Room::floor_only() {
  return {{kFloor}, {}};
}

Room Room::corridor() {
  return {{kFloor, {{0, 2, 0}, {0, -1, 0}}, {{0, -2, 0}, {0, 1, 0}}}, {}};
}

Room Room::corner() {
  return {{kFloor, {{6, 0, 0}, {-1, 0, 0}}, {{0, 6, 0}, {0, -1, 0}}}, {}};
}

double Room::cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Plane& plane : planes) {
    const double towards = -plane.normal.dot(direction);
    if (towards <= 1e-9) continue;
    const double range = plane.normal.dot(origin - plane.point_m) / towards;
    if (range > 0.0) nearest = std::min(nearest, range);
  }
  const Eigen::Vector2d d = direction.head<2>();
  for (const Pillar& pillar : pillars) {
    const Eigen::Vector2d away = origin.head<2>() - pillar.centre_m;
    const double a = d.squaredNorm(), b = away.dot(d), c = away.squaredNorm() - pillar.radius_m * pillar.radius_m;
    const double root = b * b - a * c;
    if (root <= 0.0 || a < 1e-12) continue;
    const double range = (-b - std::sqrt(root)) / a;
    if (range > 0.0) nearest = std::min(nearest, range);
  }
  return nearest < 100.0 ? nearest : -1.0;
}

double Room::distance(const Eigen::Vector3d& point) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Plane& plane : planes) nearest = std::min(nearest, std::abs(plane.normal.dot(point - plane.point_m)));
  for (const Pillar& pillar : pillars) {
    nearest = std::min(nearest, std::abs((point.head<2>() - pillar.centre_m).norm() - pillar.radius_m));
  }
  return nearest;
}

Eigen::Vector3d Motion::p_m(double t) const {
  const double s = std::max(t - rest_s, 0.0);
  return swing *
         Eigen::Vector3d(2.5 * (1 - std::cos(1.5 * s)), 1.8 * (1 - std::cos(1.1 * s)), 0.6 * (1 - std::cos(2 * s)));
}

Eigen::Vector3d Motion::v_m_s(double t) const {
  const double s = std::max(t - rest_s, 0.0);
  return swing *
         Eigen::Vector3d(2.5 * 1.5 * std::sin(1.5 * s), 1.8 * 1.1 * std::sin(1.1 * s), 0.6 * 2 * std::sin(2 * s));
}

Eigen::Vector3d Motion::a_m_s2(double t) const {
  if (t < rest_s) return Eigen::Vector3d::Zero();
  const double s = t - rest_s;
  return swing *
         Eigen::Vector3d(2.5 * 2.25 * std::cos(1.5 * s), 1.8 * 1.21 * std::cos(1.1 * s), 0.6 * 4 * std::cos(2 * s));
}

Eigen::Quaterniond Motion::q(double t) const {
  const double s = risen(t - rest_s, 0.5);
  const Eigen::Vector3d axis = Eigen::Vector3d(0.4, -0.3, 0.85).normalized();
  return so3::exp(second_spin_rad_s * s * Eigen::Vector3d::UnitY()) * so3::exp(spin_rad_s * s * axis);
}

Eigen::Isometry3d Motion::pose(double t) const {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = q(t).toRotationMatrix();
  T.translation() = p_m(t);
  return T;
}

std::vector<ImuSample> make_imu(const Motion& motion, double duration_s, double rate_hz) {
  const std::int64_t period_ns = static_cast<std::int64_t>(std::llround(1e9 / rate_hz));
  const int count = static_cast<int>(std::llround(duration_s * rate_hz));
  const double dt = 1e-9 * static_cast<double>(period_ns);
  constexpr int kParts = 16;  // Simpson's rule
  std::vector<ImuSample> samples(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    const double t0 = 1e-9 * static_cast<double>(k * period_ns);
    ImuSample& sample = samples[static_cast<std::size_t>(k)];
    sample.time_ns = (k + 1) * period_ns;
    sample.angular_velocity_rad_s = so3::logarithm(motion.q(t0).conjugate() * motion.q(t0 + dt)) / dt;
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    for (int i = 0; i <= kParts; ++i) {
      // slightly inside the window, where the jump of acceleration at the end of rest belongs to one side
      const double t = t0 + dt * (1e-6 + (1.0 - 2e-6) * i / kParts);
      const double weight = (i == 0 || i == kParts) ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
      force += weight * (motion.q(t).conjugate() * (motion.a_m_s2(t) + Eigen::Vector3d(0, 0, kRoomGravity_m_s2)));
    }
    sample.specific_force_m_s2 = force / (3.0 * kParts);
  }
  return samples;
}

std::vector<MotionSample> motion_samples(const std::vector<ImuSample>& imu) {
  std::vector<MotionSample> samples;
  for (const ImuSample& sample : imu) {
    MotionSample& out = samples.emplace_back();
    out.from_ns = samples.size() == 1 ? 0 : samples[samples.size() - 2].time_ns;
    out.time_ns = sample.time_ns;
    out.w_WI_I_rad_s = sample.angular_velocity_rad_s;
    out.f_I_m_s2 = sample.specific_force_m_s2;
  }
  return samples;
}

AngularRateState believe(const ImuSample& sample) {
  AngularRateState rate;
  rate.time_ns = sample.time_ns;
  rate.w_WI_I_rad_s = sample.angular_velocity_rad_s;
  return rate;
}

std::vector<LidarPoint> make_sweep(const Room& room, const Motion& motion, const Eigen::Isometry3d& T_IL, int sweep,
                                   double noise_m, int columns) {
  std::vector<LidarPoint> points;
  points.reserve(static_cast<std::size_t>(kRings * columns));
  for (int column = 0; column < columns; ++column) {
    for (int ring = 0; ring < kRings; ++ring) {
      const std::int64_t offset_ns = column * (kSweep_ns / columns) + ring * 3000;
      const double t = 1e-9 * static_cast<double>(sweep * kSweep_ns + offset_ns);
      const double elevation = (-15.0 + 2.0 * ring) * std::numbers::pi / 180.0;
      const double azimuth = -2.0 * std::numbers::pi * column / columns;
      const Eigen::Vector3d d_L(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                std::sin(elevation));
      const Eigen::Isometry3d T_WL = motion.pose(t) * T_IL;
      const double range = room.cast(T_WL.translation(), T_WL.linear() * d_L);
      if (range < 0.0) continue;
      const std::uint64_t counter =
          (static_cast<std::uint64_t>(sweep) << 20) + static_cast<std::uint64_t>(column * kRings + ring);
      const double noise = noise_m * std::sqrt(12.0) * (uniform(counter) - 0.5);
      LidarPoint& point = points.emplace_back();
      point.position_L_m = ((range + noise) * d_L).cast<float>();
      point.offset_ns = static_cast<std::uint32_t>(offset_ns);
      point.ring = static_cast<std::uint16_t>(ring);
    }
  }
  return points;
}

double uniform(std::uint64_t counter) {
  std::uint64_t z = counter * 0x9e3779b97f4a7c15u + 0x2545f4914f6cdd1du;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

}  // namespace tumble::test
