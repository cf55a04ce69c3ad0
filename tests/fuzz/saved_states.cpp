// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/saved_states.hpp"

#include <cmath>
#include <cstdint>
#include <tumble/tumble.hpp>
#include <vector>

#include "tests/fuzz/saved_edits.hpp"

namespace tumble::fuzz {

namespace {

ImuSample sample_at(int k) {
  ImuSample out;
  out.time_ns = k * TimeNs{10'000'000};
  const double turn = k < 12 ? 0.0 : 0.3 * (k - 12);
  out.angular_velocity_rad_s = {0.2 * turn, turn, -0.1 * turn};
  out.specific_force_m_s2 = {0.1 * turn, 0.0, 9.8};
  return out;
}

/// Returns points of a floor and a wall.
std::vector<LidarPoint> some_points() {
  std::vector<LidarPoint> out;
  for (int k = 0; k < 400; ++k) {
    LidarPoint& point = out.emplace_back();
    const float a = 0.0157f * static_cast<float>(k);
    point.position_L_m = k % 2 == 0 ? Eigen::Vector3f(2.0f + 0.005f * static_cast<float>(k), 3.0f * std::sin(a), -1.0f)
                                    : Eigen::Vector3f(4.0f, 3.0f * std::sin(a), std::cos(a));
    point.offset_ns = static_cast<std::uint32_t>(100'000 * k);
    point.ring = static_cast<std::uint16_t>(k % 4);
  }
  return out;
}

struct Tumbling {
  using Estimator = TumblingOdometry;
  static Estimator::Params params() {
    Estimator::Params params;
    params.lever_arm_I_m.setZero();
    params.lag_s = 0.03;
    return params;
  }
  static Bytes saved() {
    Estimator odometry(params());
    for (int k = 1; k < 20; ++k) (void)odometry.add_imu(sample_at(k));
    const std::vector<LidarPoint> points = some_points();
    for (const TimeNs start_ns : {TimeNs{30'000'000}, TimeNs{80'000'000}, TimeNs{140'000'000}})
      (void)odometry.add_sweep(start_ns, start_ns + 50'000'000, points);
    MotionReading motion{190'000'000, 200'000'000, Eigen::Isometry3d::Identity(), {}};
    motion.covariance.setIdentity();
    (void)odometry.add_motion(motion);
    return odometry.save();
  }
  static void go_on(Estimator& odometry) {
    for (int k = 20; k < 23; ++k) (void)odometry.add_imu(sample_at(k));
    PoseState pose;
    (void)odometry.newest(pose);
    while (odometry.take()) continue;
  }
};

struct Rolling {
  using Estimator = RollingOdometry;
  static Estimator::Params params() {
    Estimator::Params params;
    params.radius_m = 0.145;
    params.lag_s = 0.1;
    params.units.resize(1);
    return params;
  }
  static Bytes saved() {
    Estimator odometry(params());
    for (int k = 1; k < 20; ++k) (void)odometry.add_imu(sample_at(k));
    return odometry.save();
  }
  static void go_on(Estimator& odometry) {
    for (int k = 20; k < 40; ++k) (void)odometry.add_imu(sample_at(k));
    while (odometry.take()) continue;
  }
};

}  // namespace

void saved_states(const std::filesystem::path& file) {
  const Edits edits = read_edits(file);
  switch (edits.letter) {
    case 'T':
      return load_spoiled<Tumbling>(edits);
    case 'R':
      return load_spoiled<Rolling>(edits);
    default:
      throw scenarios::BadInput("neither T nor R");
  }
}

}  // namespace tumble::fuzz
