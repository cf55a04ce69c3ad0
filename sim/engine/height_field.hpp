// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace tumble::sim::engine {

struct Field {
  const float* heights;
  int rows, columns;
  double half_x_m, half_y_m, scale_m, common_position_m, cell_x_m, cell_y_m;

  Field(const mjModel& model, int geom) {
    const int id = model.geom_dataid[geom];
    const mjtNum* size = model.hfield_size + 4 * id;
    heights = model.hfield_data + model.hfield_adr[id];
    rows = model.hfield_nrow[id];
    columns = model.hfield_ncol[id];
    half_x_m = size[0];
    half_y_m = size[1];
    scale_m = size[2];
    common_position_m = size[3];
    cell_x_m = 2.0 * half_x_m / (columns - 1);
    cell_y_m = 2.0 * half_y_m / (rows - 1);
  }
  double x_m(int column) const { return cell_x_m * column - half_x_m; }
  double y_m(int row) const { return cell_y_m * row - half_y_m; }
  double height_m(int row, int column) const { return scale_m * heights[row * columns + column]; }
  double higher_m(int row, int column) const {
    return scale_m * std::max(heights[row * columns + column], heights[(row + 1) * columns + column]);
  }

  /// Returns the depth of a point below the ground triangle at the horizontal position of the point. The depth is
  /// negative above the ground, and 0 outside the height field.
  double depth_m(const Eigen::Vector3d& p_m) const {
    const double across = (p_m.x() + half_x_m) / cell_x_m, along = (p_m.y() + half_y_m) / cell_y_m;
    if (!(across >= 0.0 && across <= columns - 1 && along >= 0.0 && along <= rows - 1)) return 0.0;
    const int column = std::min(static_cast<int>(across), columns - 2),
              row = std::min(static_cast<int>(along), rows - 2);
    const bool upper = along - row > across - column;
    const double first_m = height_m(row, column), last_m = height_m(row + 1, column + 1);
    const double rise_x_m = upper ? last_m - height_m(row + 1, column) : height_m(row, column + 1) - first_m;
    const double rise_y_m = upper ? height_m(row + 1, column) - first_m : last_m - height_m(row, column + 1);
    const double slope_x = rise_x_m / cell_x_m, slope_y = rise_y_m / cell_y_m;
    const double ground_m = first_m + rise_x_m * (across - column) + rise_y_m * (along - row);
    return (ground_m - p_m.z()) / std::sqrt(1.0 + slope_x * slope_x + slope_y * slope_y);
  }
};

/// Strut is a capsule of the robot's cage. Contacts are searched within the distance `reach_m` from the axis of the
/// capsule.
struct Strut {
  Eigen::Vector3d from_m, along_m;
  double radius_m, reach_m;

  Strut(const mjModel& model, const mjData& data, int field, int capsule) {
    using Map = Eigen::Map<const Eigen::Vector3d>;
    const mjtNum* turn = data.geom_xmat + 9 * capsule;
    const Eigen::Vector3d middle_m = Map(data.geom_xpos + 3 * capsule) - Map(data.geom_xpos + 3 * field);
    const Eigen::Vector3d half_m = model.geom_size[3 * capsule + 1] * Eigen::Vector3d(turn[2], turn[5], turn[8]);
    from_m = middle_m - half_m;
    along_m = 2.0 * half_m;
    radius_m = model.geom_size[3 * capsule];
    constexpr double kSlack_m = 1e-6;  // larger than all rounding errors
    reach_m = radius_m + kSlack_m;
  }
  bool finite() const { return from_m.allFinite() && along_m.allFinite(); }
  Eigen::Vector3d at_m(double share) const { return from_m + share * along_m; }
  double lowest_m(int axis) const { return from_m[axis] + std::min(0.0, along_m[axis]) - reach_m; }
  double highest_m(int axis) const { return from_m[axis] + std::max(0.0, along_m[axis]) + reach_m; }
};

/// Part is a section of a strut's axis, from the fraction `first` to the fraction `last` of the axis length. The
/// section is empty if `first` exceeds `last`.
struct Part {
  double first = 0.0, last = 1.0;
  bool none() const { return first > last; }

  Part within(const Strut& strut, int axis, double low_m, double high_m) const {
    const double from_m = strut.from_m[axis], along_m = strut.along_m[axis];
    low_m -= strut.reach_m;
    high_m += strut.reach_m;
    if (std::abs(along_m) < 1e-12) return from_m < low_m || from_m > high_m ? Part{1.0, 0.0} : *this;
    const double a = (low_m - from_m) / along_m, b = (high_m - from_m) / along_m;
    return {std::max(first, std::min(a, b)), std::min(last, std::max(a, b))};
  }
};

struct Cells {
  int first, last;
  Cells(double low_m, double high_m, double half_m, double cell_m, int count)
      : first(static_cast<int>(std::clamp(std::floor((low_m + half_m) / cell_m), 0.0, static_cast<double>(count)))),
        last(static_cast<int>(std::clamp(std::floor((high_m + half_m) / cell_m), -1.0, count - 1.0))) {}
};

}  // namespace tumble::sim::engine
