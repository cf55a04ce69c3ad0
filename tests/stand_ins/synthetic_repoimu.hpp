// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

/// The functions here make a recording in the form of RepoIMU, similar to the published ones, of a known motion.
namespace tumble::scenarios::fixture {

/// A Wand is held in a hand: it swings slowly and is sometimes twirled about x, beyond the saturation level.
struct Wand {
  double duration_s = 40.0;
  double log_hz = 100.0;
  double rail_rad_s = 7.3;
  double rail_tilt = -0.02;   ///< tilt of the x saturation limit, per rad/s of z
  double rail_y_slope = 0.0;  ///< tilt of the x saturation limit, per rad/s of y
  double rail_offset_rad_s = 0.0;
  std::vector<double> flips_s;  ///< starts of intervals of 0.15 s in which markers are confused

  static Eigen::Vector3d rate(double t) {
    const double twirl = 11.0 * std::pow(std::max(0.0, std::sin(0.9 * t)), 8.0) * std::sin(3.1 * t);
    return {twirl + 0.8 * std::sin(1.7 * t), 1.1 * std::sin(2.3 * t + 0.4), 0.9 * std::sin(1.3 * t + 1.0)};
  }
};

/// WandAttitude gives attitudes q_WI every millisecond from -0.2 s on.
class WandAttitude {
 public:
  explicit WandAttitude(double duration_s) {
    Eigen::Quaterniond q(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()));
    for (double t = kStart_s; t < duration_s + 0.5; t += kStep_s) {
      q_.push_back(q);
      const Eigen::Vector3d turn = kStep_s * Wand::rate(t + 0.5 * kStep_s);
      const double angle = turn.norm();
      if (angle > 0.0) q = (q * Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle))).normalized();
    }
  }
  Eigen::Quaterniond at(double t) const {
    const double u = (t - kStart_s) / kStep_s;
    const auto k = std::min(static_cast<std::size_t>(std::max(0.0, u)), q_.size() - 2);
    return q_[k].slerp(u - static_cast<double>(k), q_[k + 1]);
  }

 private:
  static constexpr double kStart_s = -0.2, kStep_s = 1e-3;
  std::vector<Eigen::Quaterniond> q_;
};

inline Eigen::Vector3d clipped(const Wand& wand, Eigen::Vector3d w) {
  const double centre = wand.rail_offset_rad_s + wand.rail_y_slope * w.y() + wand.rail_tilt * w.z();
  w.x() = std::clamp(w.x(), centre - wand.rail_rad_s, centre + wand.rail_rad_s);
  return w;
}

inline std::string repoimu_text(const Wand& wand) {
  const WandAttitude attitude(wand.duration_s);
  std::string text =
      "Time (s);Vicon Orientation;;;;IMU Acceleration;;;IMU Gyroscope;;;IMU Magnetometer;;;\n"
      ";W;X;Y;Z;X;Y;Z;X;Y;Z;X;Y;Z;\n";
  const int rows = static_cast<int>(wand.duration_s * wand.log_hz);
  for (int k = 0; k < rows; ++k) {
    const double t = k / wand.log_hz;
    Eigen::Quaterniond q = attitude.at(t);
    for (const double flip : wand.flips_s) {
      if (t >= flip && t < flip + 0.15) q = q * Eigen::Quaterniond(0.0, 0.7071, 0.7071, 0.0);
    }
    const Eigen::Vector3d w = clipped(wand, Wand::rate(t));
    const Eigen::Vector3d f = attitude.at(t).conjugate() * Eigen::Vector3d(0.0, 0.0, 9.80665);
    char line[400];
    std::snprintf(line, sizeof line, "%.4f;%.5f;%.5f;%.5f;%.5f;%.5g;%.5g;%.5g;%.5g;%.5g;%.5g;0.4;0.2;-0.9\n", t, q.w(),
                  q.x(), q.y(), q.z(), f.x(), f.y(), f.z(), w.x(), w.y(), w.z());
    text += line;
  }
  return text;
}

}  // namespace tumble::scenarios::fixture
