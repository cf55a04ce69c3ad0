// SPDX-License-Identifier: BSD-3-Clause
#include "sim/engine/field_contact.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "sim/engine/height_field.hpp"
#include "sim/engine/prism.hpp"

namespace tumble::sim::engine {

namespace {

using Eigen::Vector3d;

/// Cell is a grid cell of a height field, which MuJoCo divides into two triangles along the diagonal from the first to
/// the last corner.
class Cell {
 public:
  Cell(const Field& field, int row, int column, const Strut& strut, const Part& over)
      : corner_m(field.x_m(column), field.y_m(row), 0.0),
        a_m(strut.at_m(over.first) - corner_m),
        b_m(strut.at_m(over.last) - corner_m),
        dx_(field.cell_x_m),
        dy_(field.cell_y_m),
        foot_m_(-field.common_position_m),
        reach_m_(strut.reach_m),
        heights_m_{field.height_m(row, column), field.height_m(row, column + 1), field.height_m(row + 1, column + 1),
                   field.height_m(row + 1, column)} {}

  bool may_touch() const {
    return std::min(a_m.z(), b_m.z()) - reach_m_ <= *std::max_element(heights_m_.begin(), heights_m_.end());
  }
  bool may_touch_upper() const {
    return std::min(beside_diagonal_m(a_m), beside_diagonal_m(b_m)) <= reach_m_ &&
           !above_plane((heights_m_[2] - heights_m_[3]) / dx_, (heights_m_[3] - heights_m_[0]) / dy_);
  }
  bool may_touch_lower() const {
    return std::max(beside_diagonal_m(a_m), beside_diagonal_m(b_m)) >= -reach_m_ &&
           !above_plane((heights_m_[1] - heights_m_[0]) / dx_, (heights_m_[2] - heights_m_[1]) / dy_);
  }
  Prism upper() const { return {{first(), last(), {0, dy_, heights_m_[3]}}, foot_m_}; }
  Prism lower() const { return {{first(), {dx_, 0, heights_m_[1]}, last()}, foot_m_}; }

  const Vector3d corner_m, a_m, b_m;

 private:
  Vector3d first() const { return {0, 0, heights_m_[0]}; }
  Vector3d last() const { return {dx_, dy_, heights_m_[2]}; }
  double beside_diagonal_m(const Vector3d& p_m) const {
    return (p_m.x() * dy_ - p_m.y() * dx_) / std::sqrt(dx_ * dx_ + dy_ * dy_);
  }
  bool above_plane(double slope_x, double slope_y) const {
    const auto above_m = [&](const Vector3d& p_m) {
      return p_m.z() - heights_m_[0] - slope_x * p_m.x() - slope_y * p_m.y();
    };
    const double least_m = std::min(above_m(a_m), above_m(b_m));
    return least_m > 0.0 && least_m * least_m > reach_m_ * reach_m_ * (1.0 + slope_x * slope_x + slope_y * slope_y);
  }

  double dx_, dy_, foot_m_, reach_m_;
  std::array<double, 4> heights_m_;  ///< anticlockwise from the first corner
};

class Touched {
 public:
  Touched(const Strut& strut, const Vector3d& origin_W_m, mjPreContact* contacts)
      : radius_m_(strut.radius_m), origin_W_m_(origin_W_m), contacts_(contacts) {}

  bool add(const Cell& cell, const Prism& prism) {
    Closest closest;
    const Meeting how = meet(cell.a_m, cell.b_m, prism, radius_m_, closest);
    if (how == Meeting::near && count_ < mjMAXCONPAIR) write(closest, cell.corner_m, contacts_[count_++]);
    return how != Meeting::pierced;
  }
  int count() const { return count_; }

 private:
  void write(const Closest& closest, const Vector3d& corner_m, mjPreContact& contact) const {
    const Vector3d normal = (closest.axis_m - closest.prism_m) / closest.distance_m;
    const Vector3d surface_m = closest.axis_m - radius_m_ * normal;
    contact.dist = closest.distance_m - radius_m_;
    Vector3d::Map(contact.pos) = origin_W_m_ + corner_m + 0.5 * (closest.prism_m + surface_m);
    Vector3d::Map(contact.normal) = normal;
    Vector3d::Map(contact.tangent).setZero();
  }

  double radius_m_;
  Vector3d origin_W_m_;
  mjPreContact* contacts_;
  int count_ = 0;
};

bool turned(const mjData& data, int geom) {
  const mjtNum* turn = data.geom_xmat + 9 * geom;
  return turn[0] != 1.0 || turn[4] != 1.0 || turn[8] != 1.0;
}

mjfCollision engines_own() {
  static const mjfCollision kOwn = mjCOLLISIONFUNC[mjGEOM_HFIELD][mjGEOM_CAPSULE];
  return kOwn;
}

int field_and_capsule(const mjModel* model, mjData* data, mjPreContact* contacts, int field, int capsule,
                      mjtNum margin) {
  const std::optional<int> count =
      margin == 0.0 ? field_contacts(*model, *data, field, capsule, contacts) : std::nullopt;
  return count ? *count : engines_own()(model, data, contacts, field, capsule, margin);
}

}  // namespace

std::optional<int> field_contacts(const mjModel& model, const mjData& data, int field_geom, int capsule,
                                  mjPreContact* contacts) {
  if (turned(data, field_geom)) return std::nullopt;
  const Field field(model, field_geom);
  const Strut strut(model, data, field_geom, capsule);
  if (!strut.finite() || strut.lowest_m(2) <= -field.common_position_m) return std::nullopt;

  Touched touched(strut, Vector3d::Map(data.geom_xpos + 3 * field_geom), contacts);
  const Cells rows(strut.lowest_m(1), strut.highest_m(1), field.half_y_m, field.cell_y_m, field.rows - 1);
  const Cells columns(strut.lowest_m(0), strut.highest_m(0), field.half_x_m, field.cell_x_m, field.columns - 1);
  for (int row = rows.first; row <= rows.last; ++row) {
    const Part in_row = Part{}.within(strut, 1, field.y_m(row), field.y_m(row + 1));
    if (in_row.none()) continue;
    const double lowest_m = std::min(strut.at_m(in_row.first).z(), strut.at_m(in_row.last).z()) - strut.reach_m;
    double left_m = field.higher_m(row, columns.first), right_m;
    for (int column = columns.first; column <= columns.last; ++column, left_m = right_m) {
      right_m = field.higher_m(row, column + 1);
      if (lowest_m > std::max(left_m, right_m)) continue;
      const Part over = in_row.within(strut, 0, field.x_m(column), field.x_m(column + 1));
      if (over.none()) continue;
      const Cell cell(field, row, column, strut, over);
      if (!cell.may_touch()) continue;
      if (cell.may_touch_upper() && !touched.add(cell, cell.upper())) return std::nullopt;
      if (cell.may_touch_lower() && !touched.add(cell, cell.lower())) return std::nullopt;
    }
  }
  return touched.count();
}

void find_field_contacts_by_geometry() {
  static const bool kDone = [] {
    engines_own();
    mjCOLLISIONFUNC[mjGEOM_HFIELD][mjGEOM_CAPSULE] = field_and_capsule;
    return true;
  }();
  (void)kDone;
}

}  // namespace tumble::sim::engine
