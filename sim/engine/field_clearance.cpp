// SPDX-License-Identifier: BSD-3-Clause
#include "sim/engine/field_clearance.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace tumble::sim::engine {

namespace {

using Eigen::Vector3d;

/// More than the engine's tolerance of a contact (1e-6 m), and than all rounding here.
constexpr double kSlack_m = 1e-4;

/// Heights over a regular grid, in the axes of the geom; a column leads along x.
struct Field {
  const float* heights;
  int rows, columns;
  double half_x_m, half_y_m, scale_m, base_m, cell_x_m, cell_y_m;

  Field(const mjModel& model, int geom) {
    const int id = model.geom_dataid[geom];
    const mjtNum* size = model.hfield_size + 4 * id;
    heights = model.hfield_data + model.hfield_adr[id];
    rows = model.hfield_nrow[id];
    columns = model.hfield_ncol[id];
    half_x_m = size[0];
    half_y_m = size[1];
    scale_m = size[2];
    base_m = size[3];
    cell_x_m = 2.0 * half_x_m / (columns - 1);
    cell_y_m = 2.0 * half_y_m / (rows - 1);
  }
  double x_m(int column) const { return cell_x_m * column - half_x_m; }
  double y_m(int row) const { return cell_y_m * row - half_y_m; }
  double height_m(int row, int column) const { return scale_m * heights[row * columns + column]; }
};

/// A capsule in the axes of the field: its axis from one end to the other, and how far it reaches from it.
struct Strut {
  Vector3d from_m, along_m;
  double reach_m;

  Strut(const mjModel& model, const mjData& data, int field, int capsule) {
    using Map = Eigen::Map<const Vector3d>;
    const mjtNum* turn = data.geom_xmat + 9 * capsule;
    const Vector3d middle_m = Map(data.geom_xpos + 3 * capsule) - Map(data.geom_xpos + 3 * field);
    const Vector3d half_m = model.geom_size[3 * capsule + 1] * Vector3d(turn[2], turn[5], turn[8]);
    from_m = middle_m - half_m;
    along_m = 2.0 * half_m;
    reach_m = model.geom_size[3 * capsule] + kSlack_m;
  }
  Vector3d at_m(double share) const { return from_m + share * along_m; }
  double lowest_m(int axis) const { return from_m[axis] + std::min(0.0, along_m[axis]) - reach_m; }
  double highest_m(int axis) const { return from_m[axis] + std::max(0.0, along_m[axis]) + reach_m; }
};

/// Shares of the axis from the first to the last; none when they are the wrong way round.
struct Part {
  double first = 0.0, last = 1.0;
  bool none() const { return first > last; }

  /// The share of it whose coordinate lies between the two, the reach added to both sides.
  Part within(const Strut& strut, int axis, double low_m, double high_m) const {
    const double from_m = strut.from_m[axis], along_m = strut.along_m[axis];
    low_m -= strut.reach_m;
    high_m += strut.reach_m;
    if (std::abs(along_m) < 1e-12) return from_m < low_m || from_m > high_m ? Part{1.0, 0.0} : *this;
    const double a = (low_m - from_m) / along_m, b = (high_m - from_m) / along_m;
    return {std::max(first, std::min(a, b)), std::min(last, std::max(a, b))};
  }
};

/// First and last cell, in one direction, that a strut's box overlaps; none when they are the wrong way round.
struct Cells {
  int first, last;
  Cells(double low_m, double high_m, double half_m, double cell_m, int count)
      : first(static_cast<int>(std::clamp(std::floor((low_m + half_m) / cell_m), 0.0, static_cast<double>(count)))),
        last(static_cast<int>(std::clamp(std::floor((high_m + half_m) / cell_m), -1.0, count - 1.0))) {}
};

/// Whether both points, and so all between them, are further than `reach_m` above the plane through (0, 0, z_m).
bool above_plane(const Vector3d& a_m, const Vector3d& b_m, double z_m, double slope_x, double slope_y, double reach_m) {
  const auto above_m = [&](const Vector3d& p_m) { return p_m.z() - z_m - slope_x * p_m.x() - slope_y * p_m.y(); };
  const double least_m = std::min(above_m(a_m), above_m(b_m));
  return least_m > 0.0 && least_m * least_m > reach_m * reach_m * (1.0 + slope_x * slope_x + slope_y * slope_y);
}

/// `part` is what of the axis lies over the cell's row.
bool clear_of_cell(const Strut& strut, const Field& field, int row, int column, const Part& part) {
  const double x_m = field.x_m(column);
  const Part over = part.within(strut, 0, x_m, x_m + field.cell_x_m);
  if (over.none()) return true;
  const double z00_m = field.height_m(row, column), z01_m = field.height_m(row, column + 1);
  const double z10_m = field.height_m(row + 1, column), z11_m = field.height_m(row + 1, column + 1);
  const Vector3d corner_m(x_m, field.y_m(row), 0.0);
  const Vector3d a_m = strut.at_m(over.first) - corner_m, b_m = strut.at_m(over.last) - corner_m;
  if (std::min(a_m.z(), b_m.z()) - strut.reach_m > std::max({z00_m, z01_m, z10_m, z11_m})) return true;
  // the engine divides a cell along its diagonal from (row, column) to (row + 1, column + 1)
  const double dx = field.cell_x_m, dy = field.cell_y_m;
  return above_plane(a_m, b_m, z00_m, (z11_m - z10_m) / dx, (z10_m - z00_m) / dy, strut.reach_m) &&
         above_plane(a_m, b_m, z00_m, (z01_m - z00_m) / dx, (z11_m - z01_m) / dy, strut.reach_m);
}

bool turned(const mjData& data, int geom) {
  const mjtNum* turn = data.geom_xmat + 9 * geom;
  return turn[0] != 1.0 || turn[4] != 1.0 || turn[8] != 1.0;
}

/// The engine's own function, which the table holds until the first call of this: that is before it is replaced.
mjfCollision engines_own() {
  static const mjfCollision kOwn = mjCOLLISIONFUNC[mjGEOM_HFIELD][mjGEOM_CAPSULE];
  return kOwn;
}

int field_and_capsule(const mjModel* model, mjData* data, mjPreContact* contacts, int field, int capsule,
                      mjtNum margin) {
  if (margin == 0.0 && clear_of_field(*model, *data, field, capsule)) return 0;
  return engines_own()(model, data, contacts, field, capsule, margin);
}

}  // namespace

bool clear_of_field(const mjModel& model, const mjData& data, int field_geom, int capsule) {
  if (turned(data, field_geom)) return false;
  const Field field(model, field_geom);
  const Strut strut(model, data, field_geom, capsule);
  if (!strut.from_m.allFinite() || !strut.along_m.allFinite()) return false;
  if (strut.lowest_m(2) <= -field.base_m) return false;  // as low as the bottom of the prisms

  const Cells rows(strut.lowest_m(1), strut.highest_m(1), field.half_y_m, field.cell_y_m, field.rows - 1);
  const Cells columns(strut.lowest_m(0), strut.highest_m(0), field.half_x_m, field.cell_x_m, field.columns - 1);
  for (int row = rows.first; row <= rows.last; ++row) {
    const Part over = Part{}.within(strut, 1, field.y_m(row), field.y_m(row + 1));
    if (over.none()) continue;
    for (int column = columns.first; column <= columns.last; ++column) {
      if (!clear_of_cell(strut, field, row, column, over)) return false;
    }
  }
  return true;
}

void ask_for_clearance_first() {
  static const bool kDone = [] {
    engines_own();
    mjCOLLISIONFUNC[mjGEOM_HFIELD][mjGEOM_CAPSULE] = field_and_capsule;
    return true;
  }();
  (void)kDone;
}

}  // namespace tumble::sim::engine
