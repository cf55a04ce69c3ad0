// SPDX-License-Identifier: BSD-3-Clause
#include "tests/estimator/mapping/endless_corridor.hpp"

#include <cmath>

namespace tumble::test {

namespace {

constexpr std::int64_t kSample_ns = 10'000'000;
constexpr int kRestSweeps = 5;
constexpr double kSpeed_m_s = 1.0, kRise_s = 1.0;

/// Position of rib `k` along the corridor. The spacing varies, so that each place is unique.
double rib_m(double k) {
  return 4.0 * k + 2.0 * uniform(static_cast<std::uint64_t>(1e6 + k));
}

}  // namespace

std::vector<ImuSample> EndlessCorridor::advance() {
  const double sweep_s = 1e-9 * static_cast<double>(sweep_ns_);
  start_m_ = x_m_;
  start_m_s_ = v_m_s_;
  a_m_s2_ = sweep_ >= kRestSweeps && v_m_s_ < kSpeed_m_s - 1e-9 ? kSpeed_m_s / kRise_s : 0.0;
  x_m_ += sweep_s * start_m_s_ + 0.5 * sweep_s * sweep_s * a_m_s2_;
  v_m_s_ += sweep_s * a_m_s2_;
  std::vector<ImuSample> samples(static_cast<std::size_t>(sweep_ns_ / kSample_ns));
  for (std::size_t k = 0; k < samples.size(); ++k) {
    samples[k].time_ns = sweep_ * sweep_ns_ + static_cast<std::int64_t>(k + 1) * kSample_ns;
    samples[k].specific_force_m_s2 = Eigen::Vector3d(a_m_s2_, 0.0, 9.80665);
  }
  ++sweep_;
  return samples;
}

std::vector<LidarPoint> EndlessCorridor::points() const {
  std::vector<LidarPoint> points(static_cast<std::size_t>(points_per_sweep_));
  for (int i = 0; i < points_per_sweep_; ++i) {
    const double t = 1e-9 * static_cast<double>(sweep_ns_) * i / points_per_sweep_;
    const double x = start_m_ + start_m_s_ * t + 0.5 * a_m_s2_ * t * t;
    const auto counter = static_cast<std::uint64_t>(sweep_ * 2 * points_per_sweep_ + i);
    const double u = uniform(counter), w = uniform(counter + static_cast<std::uint64_t>(points_per_sweep_));
    // floor, two walls, and ribs across the floor that constrain the position along the corridor
    const double along = 16.0 * u - 8.0;
    Eigen::Vector3d at(x + along, 4.0 * w - 2.0, -1.0);
    if (i % 4 == 1) at = {x + along, 2.0, 2.0 * w - 1.0};
    if (i % 4 == 2) at = {x + along, -2.0, 2.0 * w - 1.0};
    if (i % 4 == 3) at = {rib_m(std::round((x + along) / 4.0)), 3.0 * w - 1.5, -1.0 + 0.8 * u};
    LidarPoint& point = points[static_cast<std::size_t>(i)];
    point.position_L_m = (at - Eigen::Vector3d(x, 0.0, 0.0)).cast<float>();
    point.offset_ns = static_cast<std::uint32_t>(1e9 * t);
    point.ring = static_cast<std::uint16_t>(i % 16);
  }
  return points;
}

LidarInertialOdometry::Params corridor_params() {
  LidarInertialOdometry::Params params;
  params.own_body_L.setEmpty();
  params.range_max_m = 15.0;
  params.expert.map.radius_m = 20.0;
  return params;
}

}  // namespace tumble::test
