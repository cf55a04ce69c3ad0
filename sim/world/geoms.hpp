// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>

#include "sim/engine/model.hpp"
#include "sim/parameters.hpp"

namespace tumble::sim {

using Colour = std::array<float, 4>;

/// Two tables of parameters as one.
template <std::size_t M, std::size_t N>
constexpr std::array<Parameter, M + N> joined(const std::array<Parameter, M>& first,
                                              const std::array<Parameter, N>& second) {
  std::array<Parameter, M + N> all{};
  for (std::size_t i = 0; i < M; ++i) all[i] = first[i];
  for (std::size_t i = 0; i < N; ++i) all[M + i] = second[i];
  return all;
}

/// Adds a static geom that a robot touches and a lidar sees, and registers it as a surface of `world`. `size` as MuJoCo
/// has it for the type (half widths, radius and half height); `yaw_rad` about z. The caller may set more on what is
/// returned.
mjsGeom* add_surface(mjSpec* spec, engine::World& world, const std::string& name, mjtGeom type,
                     const Eigen::Vector3d& position_W_m, const Eigen::Vector3d& size_m, double yaw_rad,
                     const Colour& colour);

/// Adds a flat mark on the floor that is drawn only: nothing touches it and it is no surface.
void add_mark(mjSpec* spec, const engine::FrictionPatch& patch, const Colour& colour);

/// Adds the sun, and the sky that pictures show.
void add_daylight(mjSpec* spec);

}  // namespace tumble::sim
