// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/built_situation.hpp"

namespace tumble::sim {

struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

struct DrawnPath {
  std::vector<Eigen::Vector3d> points_W_m;
  std::array<float, 4> rgba = {1, 1, 1, 1};
  double width_m = 0.02;
  std::string name{};  ///< for the legend; empty: no entry
};

struct DrawnPoints {
  std::vector<Eigen::Vector3d> points_W_m;
  std::vector<std::array<float, 4>> rgba;
  double radius_m = 0.02;
};

/// View is the camera and the content of a picture. The camera looks at the point `look_at_W_m`. If `look_at_W_m` is
/// NaN, the camera frames the robots and nearby paths.
struct View {
  std::vector<Eigen::Isometry3d> robots_T_WB;
  std::vector<DrawnPath> paths;
  std::vector<DrawnPoints> points;
  int width = 1280;
  int height = 720;
  Eigen::Vector3d look_at_W_m = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  double distance_m = 0.0;  ///< 0: the camera frames the content
  double azimuth_rad = 1.9;
  double elevation_rad = -0.45;
};

class Renderer {
 public:
  /// The shadow map has `shadow_pixels` x `shadow_pixels` pixels, so the rendering cost grows with the square of
  /// `shadow_pixels`.
  explicit Renderer(const BuiltSituation& built, int shadow_pixels = 4096);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  Picture draw(const View& view);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

Picture film_strip(std::span<const Picture> pictures, int columns);

std::vector<std::uint8_t> png_bytes(const Picture& picture);

}  // namespace tumble::sim
