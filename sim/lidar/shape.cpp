// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/shape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble::sim {

namespace {

using Eigen::Vector3d;
constexpr double kNone = std::numeric_limits<double>::infinity();

struct Roots {
  double first, second;
};

Roots solve_quadratic(double a, double b, double c) {
  const double discriminant = b * b - a * c;
  if (!(discriminant > 0.0) || !(a > 0.0)) return {std::nan(""), std::nan("")};
  const double root = std::sqrt(discriminant);
  return {(-b - root) / a, (-b + root) / a};
}

double first_ahead(Roots roots) {
  if (roots.first >= 0.0) return roots.first;
  return roots.second >= 0.0 ? roots.second : kNone;
}

double cast_plane(const Vector3d& size, const Vector3d& o, const Vector3d& d, Vector3d& normal) {
  if (!(d.z() < 0.0)) return kNone;
  const double x = -o.z() / d.z();
  if (!(x >= 0.0)) return kNone;
  const Vector3d p = o + x * d;
  if ((size.x() > 0.0 && std::abs(p.x()) > size.x()) || (size.y() > 0.0 && std::abs(p.y()) > size.y())) return kNone;
  normal = Vector3d::UnitZ();
  return x;
}

double cast_sphere(double radius, const Vector3d& o, const Vector3d& d, Vector3d& normal) {
  const double x = first_ahead(solve_quadratic(1.0, o.dot(d), o.squaredNorm() - radius * radius));
  if (x < kNone) normal = (o + x * d) / radius;
  return x;
}

double cast_ellipsoid(const Vector3d& size, const Vector3d& o, const Vector3d& d, Vector3d& normal) {
  const Vector3d so = o.cwiseQuotient(size), sd = d.cwiseQuotient(size);
  const double x = first_ahead(solve_quadratic(sd.squaredNorm(), so.dot(sd), so.squaredNorm() - 1.0));
  if (x < kNone) normal = (so + x * sd).cwiseQuotient(size).normalized();
  return x;
}

Roots tube_roots(double radius, const Vector3d& o, const Vector3d& d) {
  return solve_quadratic(d.x() * d.x() + d.y() * d.y(), o.x() * d.x() + o.y() * d.y(),
                         o.x() * o.x() + o.y() * o.y() - radius * radius);
}

double cast_capsule(double radius, double half, const Vector3d& o, const Vector3d& d, Vector3d& normal) {
  double best = kNone;
  const auto offer = [&](double x, double axis_z) {
    if (!(x >= 0.0) || !(x < best)) return;
    best = x;
    normal = (o + x * d - Vector3d(0.0, 0.0, axis_z)) / radius;
  };
  const Roots tube = tube_roots(radius, o, d);
  for (const double x : {tube.first, tube.second}) {
    const double z = o.z() + x * d.z();
    if (std::abs(z) <= half) offer(x, z);
  }
  for (const double end : {-half, half}) {
    const Vector3d from_end = o - Vector3d(0.0, 0.0, end);
    const Roots cap = solve_quadratic(1.0, from_end.dot(d), from_end.squaredNorm() - radius * radius);
    for (const double x : {cap.first, cap.second}) {
      const double beyond = from_end.z() + x * d.z();
      if (end < 0.0 ? beyond <= 0.0 : beyond >= 0.0) offer(x, end);
    }
  }
  return best;
}

double cast_cylinder(double radius, double half, const Vector3d& o, const Vector3d& d, Vector3d& normal) {
  double best = kNone;
  if (d.z() != 0.0) {
    for (const double side : {-1.0, 1.0}) {
      const double x = (side * half - o.z()) / d.z();
      const Vector3d p = o + x * d;
      if (x >= 0.0 && x < best && p.head<2>().squaredNorm() <= radius * radius) {
        best = x;
        normal = Vector3d(0.0, 0.0, side);
      }
    }
  }
  const Roots tube = tube_roots(radius, o, d);
  for (const double x : {tube.first, tube.second}) {
    if (x >= 0.0 && x < best && std::abs(o.z() + x * d.z()) <= half) {
      best = x;
      normal = Vector3d(o.x() + x * d.x(), o.y() + x * d.y(), 0.0) / radius;
    }
  }
  return best;
}

double cast_box(const Vector3d& half, const Vector3d& o, const Vector3d& d, Vector3d& normal) {
  double enter = -kNone, leave = kNone;
  int enter_axis = -1, leave_axis = -1;
  for (int axis = 0; axis < 3; ++axis) {
    if (d[axis] == 0.0) {
      if (std::abs(o[axis]) > half[axis]) return kNone;
      continue;
    }
    double near = (-half[axis] - o[axis]) / d[axis], far = (half[axis] - o[axis]) / d[axis];
    if (near > far) std::swap(near, far);
    if (near > enter) {
      enter = near;
      enter_axis = axis;
    }
    if (far < leave) {
      leave = far;
      leave_axis = axis;
    }
  }
  if (enter > leave || leave < 0.0) return kNone;
  const bool outside = enter >= 0.0;
  const int axis = outside ? enter_axis : leave_axis;
  normal.setZero();
  normal[axis] = (d[axis] > 0.0) == outside ? -1.0 : 1.0;
  return outside ? enter : leave;
}

template <typename Vector>
double signed_box_distance(const Vector& point, const Vector& half) {
  const Vector beyond = point.cwiseAbs() - half;
  const double outside = beyond.cwiseMax(0.0).norm();
  return outside > 0.0 ? outside : beyond.maxCoeff();
}

/// Returns the distance of a point y from an ellipsoid with half axes a_i. The nearest point of the ellipsoid follows
/// from the root t > -min a_i^2 of the equation sum (a_i y_i / (t + a_i^2))^2 = 1.
double ellipsoid_distance(const Vector3d& size, const Vector3d& point) {
  const double scale = size.maxCoeff();
  const Vector3d a = size / scale, y = point.cwiseAbs() / scale;
  const Vector3d a2 = a.cwiseAbs2();
  const auto outside = [&](double t) {
    return a.cwiseProduct(y).cwiseQuotient(a2 + Vector3d::Constant(t)).squaredNorm() - 1;
  };
  double low = -a2.minCoeff(), high = a.cwiseProduct(y).norm();
  for (int i = 0; i < 100 && high - low > 1e-15 * (1.0 + std::abs(high)); ++i) {
    const double middle = 0.5 * (low + high);
    (outside(middle) > 0.0 ? low : high) = middle;
  }
  Vector3d nearest = a2.cwiseProduct(y).cwiseQuotient(a2 + Vector3d::Constant(high));
  // If the point is on the symmetry plane perpendicular to the shortest axis, the root does not determine the
  // coordinate along the shortest axis. The coordinate along the shortest axis then follows from the equation of the
  // ellipsoid.
  int shortest = 0;
  a.minCoeff(&shortest);
  if (y[shortest] < 1e-12) {
    nearest[shortest] = 0.0;
    const double rest = 1.0 - nearest.cwiseQuotient(a).squaredNorm();
    nearest[shortest] = a[shortest] * std::sqrt(std::max(0.0, rest));
  }
  return scale * (nearest - y).norm();
}

}  // namespace

double cast_ray(const Shape& shape, const Vector3d& origin_F_m, const Vector3d& direction_F, Vector3d& normal_F) {
  const Vector3d o = shape.R_FS.transpose() * (origin_F_m - shape.p_FS_m);
  const Vector3d d = shape.R_FS.transpose() * direction_F;
  Vector3d normal = Vector3d::Zero();
  double range = kNone;
  switch (shape.kind) {
    case ShapeKind::plane:
      range = cast_plane(shape.size_m, o, d, normal);
      break;
    case ShapeKind::sphere:
      range = cast_sphere(shape.size_m.x(), o, d, normal);
      break;
    case ShapeKind::capsule:
      range = cast_capsule(shape.size_m.x(), shape.size_m.y(), o, d, normal);
      break;
    case ShapeKind::ellipsoid:
      range = cast_ellipsoid(shape.size_m, o, d, normal);
      break;
    case ShapeKind::cylinder:
      range = cast_cylinder(shape.size_m.x(), shape.size_m.y(), o, d, normal);
      break;
    case ShapeKind::box:
      range = cast_box(shape.size_m, o, d, normal);
      break;
  }
  if (range == kNone) return range;
  normal_F = shape.R_FS * normal;
  return range;
}

double surface_distance(const Shape& shape, const Vector3d& point_F_m) {
  const Vector3d p = shape.R_FS.transpose() * (point_F_m - shape.p_FS_m);
  const Vector3d& size = shape.size_m;
  switch (shape.kind) {
    case ShapeKind::plane: {
      const double dx = size.x() > 0.0 ? std::max(0.0, std::abs(p.x()) - size.x()) : 0.0;
      const double dy = size.y() > 0.0 ? std::max(0.0, std::abs(p.y()) - size.y()) : 0.0;
      return std::hypot(dx, dy, p.z());
    }
    case ShapeKind::sphere:
      return std::abs(p.norm() - size.x());
    case ShapeKind::capsule: {
      const double z = p.z() - std::clamp(p.z(), -size.y(), size.y());
      return std::abs(std::hypot(p.x(), p.y(), z) - size.x());
    }
    case ShapeKind::ellipsoid:
      return ellipsoid_distance(size, p);
    case ShapeKind::cylinder:
      return std::abs(signed_box_distance<Eigen::Vector2d>({std::hypot(p.x(), p.y()), p.z()}, {size.x(), size.y()}));
    case ShapeKind::box:
      return std::abs(signed_box_distance<Vector3d>(p, size));
  }
  return kNone;
}

bool contains(const Shape& shape, const Vector3d& point_F_m) {
  const Vector3d p = shape.R_FS.transpose() * (point_F_m - shape.p_FS_m);
  const Vector3d& size = shape.size_m;
  switch (shape.kind) {
    case ShapeKind::plane:
      return false;
    case ShapeKind::sphere:
      return p.norm() < size.x();
    case ShapeKind::capsule:
      return std::hypot(p.x(), p.y(), p.z() - std::clamp(p.z(), -size.y(), size.y())) < size.x();
    case ShapeKind::ellipsoid:
      return p.cwiseQuotient(size).norm() < 1.0;
    case ShapeKind::cylinder:
      return std::hypot(p.x(), p.y()) < size.x() && std::abs(p.z()) < size.y();
    case ShapeKind::box:
      return (p.cwiseAbs() - size).maxCoeff() < 0.0;
  }
  return false;
}

Vector3d half_extent(const Shape& shape) {
  const Vector3d& size = shape.size_m;
  switch (shape.kind) {
    case ShapeKind::plane:
      return {size.x() > 0.0 ? size.x() : kNone, size.y() > 0.0 ? size.y() : kNone, 0.0};
    case ShapeKind::sphere:
      return Vector3d::Constant(size.x());
    case ShapeKind::capsule:
      return {size.x(), size.x(), size.x() + size.y()};
    case ShapeKind::cylinder:
      return {size.x(), size.x(), size.y()};
    case ShapeKind::ellipsoid:
    case ShapeKind::box:
      return size;
  }
  return size;
}

}  // namespace tumble::sim
