// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/estimates/method.hpp"
#include "sim/lidar/surface.hpp"
#include "sim/recording.hpp"
#include "sim/render/renderer.hpp"

namespace tumble::tools {

/// Map errors from this value [m] have the last colour of the scale.
inline constexpr float kMapErrorMax_m = 1.0f;

/// The map is in world axes, aligned with the truth by position and heading at the start, like the scores.
struct ErrorMap {
  std::string name;  ///< for example "slam/icp_raw"
  std::vector<Eigen::Vector3f> points_W_m;
  std::vector<float> error_m;  ///< at most kMapErrorMax_m
  double share_within(float limit_m) const;
};

ErrorMap map_by_error(const std::string& name, const scenarios::Estimate& estimate, const sim::Truth& truth,
                      const sim::Surface& surface);

std::array<std::uint8_t, 3> error_colour(float error_m);

sim::Picture map_picture(const std::vector<ErrorMap>& maps, const sim::Truth& truth, int width, int height);

}  // namespace tumble::tools
