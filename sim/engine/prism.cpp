// SPDX-License-Identifier: BSD-3-Clause
#include "sim/engine/prism.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace tumble::sim::engine {

namespace {

using Eigen::Vector3d;

constexpr double kTouching_m = 1e-5;

struct Pair {
  double distance2_m2;
  Vector3d axis_m, prism_m;

  void take(const Vector3d& on_axis_m, const Vector3d& on_prism_m) {
    const double other_m2 = (on_axis_m - on_prism_m).squaredNorm();
    if (other_m2 < distance2_m2) *this = {other_m2, on_axis_m, on_prism_m};
  }
};

/// Returns the signed horizontal distance of a point from the line of an edge, multiplied by the horizontal length of
/// the edge. The distance is positive if the point is to the left of the edge, seen from above. The argument `beside_m`
/// is the vector from the start of the edge to the point.
double left_of(const Vector3d& edge_m, const Vector3d& beside_m) {
  return edge_m.x() * beside_m.y() - edge_m.y() * beside_m.x();
}

class AxisBox {
 public:
  AxisBox(const Vector3d& a_m, const Vector3d& b_m)
      : low_m_(a_m.cwiseMin(b_m) - Vector3d::Constant(kSlack_m)),
        high_m_(a_m.cwiseMax(b_m) + Vector3d::Constant(kSlack_m)) {}

  bool is_beyond(const Vector3d& from_m, const Vector3d& to_m, const Pair& closest) const {
    const double x = apart_m(0, std::min(from_m.x(), to_m.x()), std::max(from_m.x(), to_m.x()));
    const double y = apart_m(1, std::min(from_m.y(), to_m.y()), std::max(from_m.y(), to_m.y()));
    const double z = apart_m(2, std::min(from_m.z(), to_m.z()), std::max(from_m.z(), to_m.z()));
    return x * x + y * y + z * z > closest.distance2_m2;
  }
  bool is_beyond_below(const Vector3d& top_m, const Pair& closest) const {
    const double x = apart_m(0, top_m.x(), top_m.x()), y = apart_m(1, top_m.y(), top_m.y());
    const double z = std::max(low_m_.z() - top_m.z(), 0.0);
    return x * x + y * y + z * z > closest.distance2_m2;
  }

 private:
  static constexpr double kSlack_m = 1e-9;  // above all rounding errors

  double apart_m(int axis, double low_m, double high_m) const {
    return std::max(std::max(low_m_[axis] - high_m, low_m - high_m_[axis]), 0.0);
  }

  Vector3d low_m_, high_m_;
};

/// Finds the closest points of two line segments: p + s u and q + t v, with s and t in [0, 1]. Source: Ericson,
/// Real-Time Collision Detection, 5.1.9.
void meet_edge(const Vector3d& p, const Vector3d& u, const Vector3d& q, const Vector3d& v, Pair& closest) {
  const Vector3d r = p - q;
  const double a = u.squaredNorm(), e = v.squaredNorm(), b = u.dot(v), c = u.dot(r), f = v.dot(r);
  const double apart = a * e - b * b;  // 0: parallel
  double s = apart > 1e-12 * a * e ? std::clamp((b * f - c * e) / apart, 0.0, 1.0) : 0.0;
  const double t = std::clamp((b * s + f) / e, 0.0, 1.0);
  if (a > 0.0) s = std::clamp((b * t - c) / a, 0.0, 1.0);
  closest.take(p + s * u, q + t * v);
}

void meet_top(const Vector3d& end_m, const Prism& prism, const Vector3d& normal, Pair& closest) {
  const double above_m = normal.dot(end_m - prism.top_m[0]);
  if (above_m < 0.0 || above_m * above_m >= closest.distance2_m2) return;
  const Vector3d on_top_m = end_m - above_m * normal;
  for (int i = 0; i < 3; ++i) {
    if (left_of(prism.top_m[(i + 1) % 3] - prism.top_m[i], on_top_m - prism.top_m[i]) < 0.0) return;
  }
  closest.take(end_m, on_top_m);
}

void meet_side(const Vector3d& end_m, const Prism& prism, int i, Pair& closest) {
  const Vector3d& from_m = prism.top_m[i];
  const Vector3d edge_m = prism.top_m[(i + 1) % 3] - from_m, beside_m = end_m - from_m;
  if (left_of(edge_m, beside_m) > 0.0) return;  // the axis ends inside
  const double share = edge_m.head<2>().dot(beside_m.head<2>()) / edge_m.head<2>().squaredNorm();
  if (share < 0.0 || share > 1.0 || beside_m.z() > share * edge_m.z()) return;
  Vector3d on_face_m = from_m + share * edge_m;
  on_face_m.z() = end_m.z();
  closest.take(end_m, on_face_m);
}

bool pierces(const Vector3d& a_m, const Vector3d& along_m, const Prism& prism, const Vector3d& normal) {
  double first = 0.0, last = 1.0;
  for (int i = 0; i < 3; ++i) {
    const Vector3d edge_m = prism.top_m[(i + 1) % 3] - prism.top_m[i];
    const double at_start = left_of(edge_m, a_m - prism.top_m[i]), growth = left_of(edge_m, along_m);
    if (growth > 0.0) first = std::max(first, -at_start / growth);
    if (growth < 0.0) last = std::min(last, -at_start / growth);
    if (growth == 0.0 && at_start < 0.0) return false;
  }
  if (first > last) return false;
  const double start_m = normal.dot(a_m - prism.top_m[0]), rise_m = normal.dot(along_m);
  return std::min(start_m + first * rise_m, start_m + last * rise_m) <= 0.0;
}

}  // namespace

Meeting meet(const Vector3d& a_m, const Vector3d& b_m, const Prism& prism, double reach_m, Closest& closest) {
  const Vector3d normal = (prism.top_m[1] - prism.top_m[0]).cross(prism.top_m[2] - prism.top_m[0]).normalized();
  const Vector3d along_m = b_m - a_m;
  if (std::min(normal.dot(a_m - prism.top_m[0]), normal.dot(b_m - prism.top_m[0])) >= reach_m) return Meeting::apart;
  if (pierces(a_m, along_m, prism, normal)) return Meeting::pierced;

  const AxisBox box(a_m, b_m);
  Pair pair{reach_m * reach_m, a_m, a_m};
  meet_top(a_m, prism, normal, pair);
  meet_top(b_m, prism, normal, pair);
  for (int i = 0; i < 3; ++i) {
    const Vector3d &from_m = prism.top_m[i], &to_m = prism.top_m[(i + 1) % 3];
    meet_side(a_m, prism, i, pair);
    meet_side(b_m, prism, i, pair);
    if (!box.is_beyond(from_m, to_m, pair)) meet_edge(a_m, along_m, from_m, to_m - from_m, pair);
    if (!box.is_beyond_below(from_m, pair))
      meet_edge(a_m, along_m, from_m, Vector3d(0, 0, prism.foot_m - from_m.z()), pair);
  }
  if (pair.distance2_m2 >= reach_m * reach_m) return Meeting::apart;
  if (pair.distance2_m2 < kTouching_m * kTouching_m) return Meeting::pierced;
  closest = {std::sqrt(pair.distance2_m2), pair.axis_m, pair.prism_m};
  return Meeting::near;
}

}  // namespace tumble::sim::engine
