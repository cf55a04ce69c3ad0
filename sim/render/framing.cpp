// SPDX-License-Identifier: BSD-3-Clause
#include "sim/render/framing.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::sim {

namespace {

using Eigen::Vector3d;

constexpr double kNear_m = 1.0;

struct Ball {
  Vector3d centre_W_m;
  double radius_m;
};

std::vector<Ball> content(const View& view, double robot_radius_m) {
  std::vector<Ball> balls;
  Eigen::AlignedBox3d near;
  for (const Eigen::Isometry3d& T_WB : view.robots_T_WB) {
    if (!T_WB.translation().allFinite()) continue;
    balls.push_back({T_WB.translation(), robot_radius_m});
    near.extend(T_WB.translation());
  }
  // If the view contains robots, distant paths are ignored, because the path of a diverged estimate would make the
  // robots tiny.
  if (!near.isEmpty()) {
    const Vector3d margin = Vector3d::Constant(kNear_m + 0.25 * near.diagonal().norm());
    near = Eigen::AlignedBox3d(near.min() - margin, near.max() + margin);
  }
  for (const DrawnPath& path : view.paths) {
    for (const Vector3d& p : path.points_W_m) {
      if (near.isEmpty() || near.contains(p)) balls.push_back({p, path.width_m});
    }
  }
  if (balls.empty()) {
    for (const DrawnPoints& cloud : view.points) {
      for (const Vector3d& p : cloud.points_W_m) balls.push_back({p, cloud.radius_m});
    }
  }
  std::erase_if(balls, [](const Ball& ball) { return !ball.centre_W_m.allFinite(); });
  return balls;
}

}  // namespace

Framing frame(const View& view, double robot_radius_m, double fovy_rad) {
  constexpr double kMargin = 0.82;     // part of half width and height that the content fills
  constexpr double kSmallest_m = 1.2;  // the surroundings stay visible
  constexpr double kOverview_m = 25.0;
  const std::vector<Ball> balls = content(view, robot_radius_m);

  Vector3d low = Vector3d::Zero(), high = Vector3d::Zero();
  if (!balls.empty()) low = high = balls[0].centre_W_m;
  for (const Ball& ball : balls) {
    low = low.cwiseMin(ball.centre_W_m - Vector3d::Constant(ball.radius_m));
    high = high.cwiseMax(ball.centre_W_m + Vector3d::Constant(ball.radius_m));
  }
  Framing out{view.look_at_W_m.allFinite() ? view.look_at_W_m : Vector3d(0.5 * (low + high)), view.distance_m};
  if (view.distance_m > 0.0) return out;
  if (balls.empty()) return {out.look_at_W_m, kOverview_m};

  const double ca = std::cos(view.azimuth_rad), sa = std::sin(view.azimuth_rad);
  const double ce = std::cos(view.elevation_rad), se = std::sin(view.elevation_rad);
  const Vector3d forward(ce * ca, ce * sa, se), right(sa, -ca, 0.0), up = right.cross(forward);
  const double tan_y = std::tan(0.5 * fovy_rad) * kMargin, tan_x = tan_y * view.width / view.height;
  out.distance_m = kSmallest_m;
  for (const Ball& ball : balls) {
    const Vector3d offset = ball.centre_W_m - out.look_at_W_m;
    const double depth = forward.dot(offset);
    out.distance_m = std::max({out.distance_m, (std::abs(right.dot(offset)) + ball.radius_m) / tan_x - depth,
                               (std::abs(up.dot(offset)) + ball.radius_m) / tan_y - depth});
  }
  return out;
}

}  // namespace tumble::sim
