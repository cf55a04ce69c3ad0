// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tumble::sim {

/// SlopeProfile falls along +x from a level top at height 0 to a level area at the bottom, with two rounded corners
/// (softplus function).
struct SlopeProfile {
  double edge_x_m = 0.0;
  double slope_rad = 0.6;    ///< steepness, below a right angle
  double drop_m = 3.0;       ///< height of the top above the run-out
  double rounding_m = 0.25;  ///< bending length of a corner, above 0

  double length_m() const;
  double height_m(double x_m) const;
};

/// LedgeProfile is a sequence of terraces below a level top at height 0. Each drop has the horizontal length `face_m`,
/// and a sloping ledge follows each drop.
struct LedgeProfile {
  double edge_x_m = 0.0;
  int drops = 2;  ///< at least 1
  double drop_height_m = 1.5;
  double face_m = 0.1;          ///< horizontal, above 0
  double ledge_length_m = 2.0;  ///< horizontal, above 0
  double ledge_slope_rad = 0.3;

  double height_m(double x_m) const;
};

}  // namespace tumble::sim
