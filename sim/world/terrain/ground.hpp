// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "sim/world/geoms.hpp"

namespace tumble::sim {

class Ground {
 public:
  Ground(int side, double half_extent_m);

  int side() const { return side_; }
  double half_extent_m() const { return half_extent_m_; }
  double cell_m() const { return 2.0 * half_extent_m_ / (side_ - 1); }
  double coordinate_m(int index) const { return index * cell_m() - half_extent_m_; }
  double node_m(int row, int column) const { return heights_m_[static_cast<std::size_t>(row) * side_ + column]; }

  /// Returns the bilinearly interpolated height. The surface of MuJoCo's height field consists of triangles, whose
  /// heights differ by a few millimetres.
  double height_m(double x_m, double y_m) const;

  template <typename Function>
  void transform(Function f) {
    for (int row = 0; row < side_; ++row) {
      for (int column = 0; column < side_; ++column) {
        double& h = heights_m_[static_cast<std::size_t>(row) * side_ + column];
        h = f(coordinate_m(column), coordinate_m(row), h);
      }
    }
  }

  template <typename Function>
  void add_near(double x_m, double y_m, double reach_m, Function f) {
    for (int row = nearest(y_m - reach_m); row <= nearest(y_m + reach_m); ++row) {
      for (int column = nearest(x_m - reach_m); column <= nearest(x_m + reach_m); ++column) {
        heights_m_[static_cast<std::size_t>(row) * side_ + column] += f(coordinate_m(column), coordinate_m(row));
      }
    }
  }

  void add_to(mjSpec* spec, engine::World& world, const std::string& name, const Colour& colour) const;

 private:
  int nearest(double at_m) const {
    return std::clamp(static_cast<int>(std::lround((at_m + half_extent_m_) / cell_m())), 0, side_ - 1);
  }

  int side_;
  double half_extent_m_;
  std::vector<double> heights_m_;
};

double fade(double distance_m, double inner_m, double outer_m);

}  // namespace tumble::sim
