// SPDX-License-Identifier: BSD-3-Clause
// The functions in this file perform the same operations as Eigen's quaternions, in the same order. The results are
// therefore bit-identical to the results of SweepTrajectory::at.
#include <algorithm>
#include <limits>

#include "rotation_series.hpp"
#include "tumble/mapping/detail/deskew.hpp"
#include "tumble/mapping/detail/sweep_trajectory.hpp"

namespace tumble {

namespace {

constexpr int kLanes = 8;
constexpr double kNoEnd_s = std::numeric_limits<double>::infinity();
using Lane = double[kLanes];

struct PointLanes {
  int count = 0;
  alignas(16) Lane s{}, x{}, y{}, z{};
  alignas(16) Lane cosine, sinc;
};

void rotate_lever_arms(double rate2_rad2_s2, PointLanes& p) {
  alignas(16) Lane h;
  for (int l = 0; l < kLanes; ++l) {
    h[l] = 0.25 * (p.s[l] * p.s[l] * rate2_rad2_s2);
    p.cosine[l] = p.sinc[l] = 1.0;
  }
  for (const auto& [of_cosine, of_sinc] : rotation_series::kRatios) {
    for (int l = 0; l < kLanes; ++l) {
      p.cosine[l] = 1.0 - (h[l] * of_cosine) * p.cosine[l];
      p.sinc[l] = 1.0 - (h[l] * of_sinc) * p.sinc[l];
    }
  }
}

}  // namespace

/// See mapping.md (R2), (R4), (R6).
void SweepTrajectory::lever_arm_vectors(std::span<const SweepPoint> points,
                                        std::span<Eigen::Vector3f> levers_W_m) const {
  const double from_s = -kExtrapolation_s, to_s = duration_s_ + kExtrapolation_s;
  std::size_t hint = 0;
  for (std::size_t first = 0; first < points.size();) {
    const Interval& now = interval_at(std::clamp<double>(points[first].t_s, from_s, to_s), hint);
    const double begin_s = hint == 0 ? from_s : now.start_s;
    const double end_s = hint + 1 < intervals_.size() ? intervals_[hint + 1].start_s : kNoEnd_s;
    const double rate2 = now.rate_I_rad_s.squaredNorm();
    PointLanes p;
    bool small = true;
    for (; p.count < kLanes && first + p.count < points.size(); ++p.count) {
      const SweepPoint& point = points[first + p.count];
      const double t = std::clamp<double>(point.t_s, from_s, to_s);
      if (p.count > 0 && !(t >= begin_s && t < end_s)) break;
      const double s = t - now.start_s;
      small = small && s * s * rate2 <= rotation_series::kAngle2_rad2;
      p.s[p.count] = s;
      p.x[p.count] = point.x_I_m.x();
      p.y[p.count] = point.x_I_m.y();
      p.z[p.count] = point.x_I_m.z();
    }
    if (!small) {
      for (int l = 0; l < p.count; ++l) {
        const SweepPoint& point = points[first + l];
        const PreintegratedMotion at = this->at(point.t_s, hint);
        levers_W_m[first + l] = (at.preintegrated_position_m + at.q_WI * point.x_I_m.cast<double>()).cast<float>();
      }
      first += p.count;
      continue;
    }
    rotate_lever_arms(rate2, p);
    const Eigen::Quaterniond& q = now.q_WI;
    const double ax = q.x(), ay = q.y(), az = q.z(), aw = q.w();
    const Eigen::Vector3d &w = now.rate_I_rad_s, &S = now.preintegrated_position_m, &V = now.preintegrated_velocity_m_s,
                          &A = now.specific_force_W_m_s2;
    alignas(16) float ux[kLanes], uy[kLanes], uz[kLanes];
    for (int l = 0; l < kLanes; ++l) {
      const double s = p.s[l], x = p.x[l], y = p.y[l], z = p.z[l];
      const double half = 0.5 * s * p.sinc[l], bx = half * w.x(), by = half * w.y(), bz = half * w.z();
      const double bw = p.cosine[l];
      const double qx = (aw * bx + ay * bz) - (az * by - ax * bw), qy = (aw * by + ay * bw) + (az * bx - ax * bz);
      const double qz = (aw * bz - ay * bx) + (az * bw + ax * by), qw = (aw * bw - ay * by) - (az * bz + ax * bx);
      double tx = qy * z - qz * y, ty = qz * x - qx * z, tz = qx * y - qy * x;
      tx += tx;
      ty += ty;
      tz += tz;
      const double force = 0.5 * s * s;
      ux[l] = static_cast<float>((S.x() + s * V.x() + force * A.x()) + (x + qw * tx + (qy * tz - qz * ty)));
      uy[l] = static_cast<float>((S.y() + s * V.y() + force * A.y()) + (y + qw * ty + (qz * tx - qx * tz)));
      uz[l] = static_cast<float>((S.z() + s * V.z() + force * A.z()) + (z + qw * tz + (qx * ty - qy * tx)));
    }
    for (int l = 0; l < p.count; ++l) levers_W_m[first + l] = {ux[l], uy[l], uz[l]};
    first += p.count;
  }
}

}  // namespace tumble
