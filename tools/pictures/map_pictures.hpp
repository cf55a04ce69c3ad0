// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "sim/lidar/surface.hpp"
#include "sim/recording.hpp"
#include "sim/render/renderer.hpp"

/// Maps as points coloured by how far they lie from the true surface: what a bent map looks like beside a whole one.
namespace tumble::tools {

/// An error of this size or more has the last colour.
inline constexpr float kMapErrorMax_m = 1.0f;

/// A map in W, moved there by position and heading at the start alone, as the scores do.
struct ErrorMap {
  std::string name;  ///< "slam/icp_raw"
  std::vector<Eigen::Vector3f> points_W_m;
  std::vector<float> error_m;  ///< parallel: distance to the true surface, at most kMapErrorMax_m
  double share_within(float limit_m) const;
};

/// Empty when the estimate has no map, or no pose that the truth covers. Points that are not finite are left out.
ErrorMap map_by_error(const std::string& name, const scenarios::Estimate& estimate, const sim::Truth& truth,
                      const sim::Surface& surface);

/// Colour of an error: blue (on the surface), green (0.1 m), yellow (0.25 m), orange (0.5 m), red (kMapErrorMax_m).
std::array<std::uint8_t, 3> error_colour(float error_m);

/// The maps side by side in one row, seen from the same place: from the side and above, all that lies within the
/// surroundings of the true path. Nearer points hide farther ones; `width` and `height` are of one map. Below them the
/// scale of colours from 0 to kMapErrorMax_m. Throws std::invalid_argument without maps or with an empty truth.
sim::Picture map_picture(const std::vector<ErrorMap>& maps, const sim::Truth& truth, int width, int height);

}  // namespace tumble::tools
