// SPDX-License-Identifier: BSD-3-Clause
#include "thrown_body.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace tumble::test {

namespace {

constexpr double kFall_m_s2 = 9.80665;
constexpr double kThrowX_m_s = 2.0, kThrowZ_m_s = 0.5 * kFall_m_s2 * 0.8;  // up and down again in flight_s
// walls and floor of a room, and a box in it
const Eigen::AlignedBox3d kRoom{Eigen::Vector3d(-4.0, -3.0, -0.7), Eigen::Vector3d(8.0, 5.0, 3.4)};
const Eigen::AlignedBox3d kBlock{Eigen::Vector3d(4.0, 2.0, -0.7), Eigen::Vector3d(5.5, 3.5, 1.0)};

/// Rises from 0 to 1 over [0, 1] with no jerk beyond bounds at either end; and its integral from 0.
double step(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
}
double step_integral(double u) {
  const double inside = std::clamp(u, 0.0, 1.0);
  return inside * inside * inside * inside * (2.5 + inside * (-3.0 + inside)) + std::max(0.0, u - 1.0);
}

/// Length of a ray up to the room or the block from outside.
double cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
  double leave = std::numeric_limits<double>::infinity(), enter = 0.0, out = std::numeric_limits<double>::infinity();
  for (int j = 0; j < 3; ++j) {
    if (std::abs(ray[j]) < 1e-12) {
      if (origin[j] < kBlock.min()[j] || origin[j] > kBlock.max()[j]) enter = std::numeric_limits<double>::infinity();
      continue;
    }
    leave = std::min(leave, ((ray[j] > 0.0 ? kRoom.max() : kRoom.min())[j] - origin[j]) / ray[j]);
    const double a = (kBlock.min()[j] - origin[j]) / ray[j], b = (kBlock.max()[j] - origin[j]) / ray[j];
    enter = std::max(enter, std::min(a, b));
    out = std::min(out, std::max(a, b));
  }
  return enter < out ? std::min(enter, leave) : leave;
}

}  // namespace

double ThrownBody::angle_rad(double t_s) const {
  const double from_s = rest_s, until_s = rest_s + push_s + flight_s;
  return spin_rad_s * push_s * (step_integral((t_s - from_s) / push_s) - step_integral((t_s - until_s) / push_s));
}

Eigen::Vector3d ThrownBody::w_WI_I_rad_s(double t_s) const {
  const double until_s = rest_s + push_s + flight_s;
  return spin_rad_s * (step((t_s - rest_s) / push_s) - step((t_s - until_s) / push_s)) * axis;
}

// horizontally thrown and caught as it spins; vertically thrown up, in flight under gravity alone, caught
Eigen::Vector3d ThrownBody::velocity_m_s(double t_s) const {
  const double fly_s = rest_s + push_s, until_s = fly_s + flight_s;
  const double up = step((t_s - rest_s) / push_s), down = step((t_s - until_s) / push_s);
  const double fallen_s = std::clamp(t_s - fly_s, 0.0, flight_s);
  const double z = kThrowZ_m_s * up - kFall_m_s2 * fallen_s;
  return {kThrowX_m_s * (up - down), 0.0, t_s < until_s ? z : (kThrowZ_m_s - kFall_m_s2 * flight_s) * (1.0 - down)};
}

Eigen::Vector3d ThrownBody::centre_m(double t_s) const {
  const double fly_s = rest_s + push_s, until_s = fly_s + flight_s;
  const double up = push_s * step_integral((t_s - rest_s) / push_s);
  const double down = push_s * step_integral((t_s - until_s) / push_s);
  const double fallen_s = std::clamp(t_s - fly_s, 0.0, flight_s);
  const double thrown_s = up - std::max(0.0, t_s - until_s);  // as long as it goes up
  const double last_m_s = kThrowZ_m_s - kFall_m_s2 * flight_s;
  const double z = kThrowZ_m_s * thrown_s - 0.5 * kFall_m_s2 * fallen_s * fallen_s +
                   last_m_s * (std::max(0.0, t_s - until_s) - down);
  return {kThrowX_m_s * (up - down), 0.0, z};
}

Eigen::Isometry3d ThrownBody::T_WI(double t_s) const {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() = Eigen::AngleAxisd(angle_rad(t_s), axis).toRotationMatrix();
  out.translation() = centre_m(t_s) + out.linear() * lever_arm_I_m - lever_arm_I_m;  // the IMU begins at the origin
  return out;
}

std::vector<ImuSample> ThrownBody::imu() const {
  std::vector<ImuSample> out;
  const double dt_s = 1.0 / imu_hz;
  const auto velocity = [&](double t_s) {
    return Eigen::Vector3d(velocity_m_s(t_s) + T_WI(t_s).linear() * w_WI_I_rad_s(t_s).cross(lever_arm_I_m));
  };
  for (int k = 1; k * dt_s <= end_s + 1e-9; ++k) {
    const double from_s = (k - 1) * dt_s, to_s = k * dt_s;
    ImuSample sample;
    sample.time_ns = std::llround(1e9 * to_s);
    const Eigen::Vector3d rate = (angle_rad(to_s) - angle_rad(from_s)) / dt_s * axis;
    sample.angular_velocity_rad_s = rate.cwiseMin(rail_rad_s).cwiseMax(-rail_rad_s);
    // the mean force in axes that turn, by a few parts of the window
    constexpr int kParts = 8;
    for (int part = 0; part < kParts; ++part) {
      const double a_s = from_s + part * dt_s / kParts, b_s = a_s + dt_s / kParts;
      const Eigen::Vector3d force_W =
          (velocity(b_s) - velocity(a_s)) / (b_s - a_s) + kFall_m_s2 * Eigen::Vector3d::UnitZ();
      sample.specific_force_m_s2 += T_WI(0.5 * (a_s + b_s)).linear().transpose() * force_W / kParts;
    }
    out.push_back(sample);
  }
  return out;
}

std::vector<ThrownBody::Sweep> ThrownBody::sweeps() const {
  constexpr int kRings = 16, kColumns = 200;
  constexpr TimeNs kSweep_ns = 100'000'000;
  std::vector<Sweep> out;
  for (TimeNs start_ns = kSweep_ns; 1e-9 * double(start_ns + kSweep_ns) <= end_s; start_ns += kSweep_ns) {
    Sweep sweep{start_ns, start_ns + kSweep_ns, {}};
    for (int column = 0; column < kColumns; ++column) {
      const auto offset_ns = static_cast<std::uint32_t>(column * (kSweep_ns / kColumns));
      const Eigen::Isometry3d T = T_WI(1e-9 * double(start_ns + offset_ns));
      for (int ring = 0; ring < kRings; ++ring) {
        const double azimuth = 2.0 * M_PI * column / kColumns, up = (ring - 7.5) * 0.035;
        const Eigen::Vector3d ray(std::cos(up) * std::cos(azimuth), std::cos(up) * std::sin(azimuth), std::sin(up));
        const double range_m = cast(T.translation(), T.linear() * ray);
        LidarPoint point;
        point.position_L_m = (range_m * ray).cast<float>();
        point.offset_ns = offset_ns;
        point.ring = static_cast<std::uint16_t>(ring);
        sweep.points.push_back(point);
      }
    }
    out.push_back(std::move(sweep));
  }
  return out;
}

}  // namespace tumble::test
