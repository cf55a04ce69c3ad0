// SPDX-License-Identifier: BSD-3-Clause
#include "tools/pictures/map_pictures.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "scenarios/scoring/truth_track.hpp"

namespace tumble::tools {

namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr std::array<std::uint8_t, 3> kBackground = {24, 26, 30};
constexpr int kScaleHeight = 14, kPictureMargin = 6;
constexpr double kFocal = 1.7;  ///< about 60 degrees of view
constexpr double kElevation_rad = 0.6;

class Camera {
 public:
  Camera(const sim::Truth& truth, int width, int height) : width_(width), height_(height) {
    Eigen::AlignedBox3d box;
    for (const Vector3d& point : truth.p_WB_m) box.extend(point);
    centre_ = box.center();
    reach_m_ = 3.0 + 0.75 * box.diagonal().norm();
    const Vector3d moved = truth.p_WB_m.back() - truth.p_WB_m.front();
    const double azimuth = moved.head<2>().norm() < 0.2 ? 1.9 : std::atan2(moved.y(), moved.x()) + 2.0;
    const Vector3d forward(std::cos(kElevation_rad) * std::cos(azimuth), std::cos(kElevation_rad) * std::sin(azimuth),
                           -std::sin(kElevation_rad));
    const Vector3d right = forward.cross(Vector3d::UnitZ()).normalized();
    R_CW_.row(0) = right;
    R_CW_.row(1) = -right.cross(forward);  // the second image axis points down
    R_CW_.row(2) = forward;
    distance_m_ = 1.25 * reach_m_;
  }

  bool project(const Vector3f& point_W_m, int& column, int& row, double& depth_m) const {
    const Vector3d from_centre = point_W_m.cast<double>() - centre_;
    if (!(from_centre.norm() <= 1.6 * reach_m_)) return false;
    const Vector3d p_C_m = R_CW_ * from_centre + Vector3d(0.0, 0.0, distance_m_);
    depth_m = p_C_m.z();
    if (depth_m < 0.5) return false;
    const double scale = 0.5 * kFocal * std::min(width_, height_) / depth_m;
    column = static_cast<int>(std::lround(0.5 * width_ + scale * p_C_m.x()));
    row = static_cast<int>(std::lround(0.5 * height_ + scale * p_C_m.y()));
    return column >= 0 && row >= 0 && column < width_ && row < height_;
  }

 private:
  int width_, height_;
  Vector3d centre_;
  double reach_m_ = 0.0, distance_m_ = 0.0;
  Eigen::Matrix3d R_CW_;
};

void set_pixel(sim::Picture& picture, int column, int row, const std::array<std::uint8_t, 3>& colour) {
  const std::size_t at =
      3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(column));
  std::copy(colour.begin(), colour.end(), picture.rgb.begin() + static_cast<std::ptrdiff_t>(at));
}

void draw_map(const ErrorMap& map, const Camera& camera, int left, int width, int height, sim::Picture& picture) {
  std::vector<double> nearest_m(static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                                std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < map.points_W_m.size(); ++i) {
    int column = 0, row = 0;
    double depth_m = 0.0;
    if (!camera.project(map.points_W_m[i], column, row, depth_m)) continue;
    const std::array<std::uint8_t, 3> colour = error_colour(map.error_m[i]);
    for (int y = row; y < std::min(row + 2, height); ++y) {
      for (int x = column; x < std::min(column + 2, width); ++x) {
        double& nearest =
            nearest_m[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
        if (depth_m >= nearest) continue;
        nearest = depth_m;
        set_pixel(picture, left + x, y, colour);
      }
    }
  }
}

}  // namespace

double ErrorMap::share_within(float limit_m) const {
  if (error_m.empty()) return 0.0;
  const auto within = std::count_if(error_m.begin(), error_m.end(), [&](float e) { return e <= limit_m; });
  return static_cast<double>(within) / static_cast<double>(error_m.size());
}

ErrorMap map_by_error(const std::string& name, const scenarios::Estimate& estimate, const sim::Truth& truth,
                      const sim::Surface& surface) {
  ErrorMap map;
  map.name = name;
  if (estimate.map.empty() || truth.p_WB_m.empty()) return map;
  const scenarios::PairedTrack track = pair_poses(estimate, scenarios::TruthTrack(truth, estimate.frame));
  if (track.poses.empty()) return map;
  const Eigen::Isometry3d to_world = track.alignment.transform();
  for (const MapPoint& point : estimate.map) {
    const Vector3f moved = (to_world * point.position_W_m.cast<double>()).cast<float>();
    if (moved.allFinite()) map.points_W_m.push_back(moved);
  }
  map.error_m = surface.distances(map.points_W_m, kMapErrorMax_m);
  return map;
}

std::array<std::uint8_t, 3> error_colour(float error_m) {
  struct Stop {
    float error_m;
    std::array<float, 3> rgb;
  };
  static constexpr std::array<Stop, 5> kStops = {{{0.0f, {49, 110, 200}},
                                                  {0.1f, {90, 190, 140}},
                                                  {0.25f, {245, 225, 90}},
                                                  {0.5f, {245, 140, 50}},
                                                  {kMapErrorMax_m, {215, 25, 40}}}};
  std::size_t above = 1;
  while (above + 1 < kStops.size() && error_m > kStops[above].error_m) ++above;
  const Stop &low = kStops[above - 1], &high = kStops[above];
  const float share = std::clamp((error_m - low.error_m) / (high.error_m - low.error_m), 0.0f, 1.0f);
  std::array<std::uint8_t, 3> colour;
  for (std::size_t c = 0; c < 3; ++c)
    colour[c] = static_cast<std::uint8_t>(std::lround(low.rgb[c] + share * (high.rgb[c] - low.rgb[c])));
  return colour;
}

sim::Picture map_picture(const std::vector<ErrorMap>& maps, const sim::Truth& truth, int width, int height) {
  if (maps.empty() || truth.p_WB_m.empty() || width < 1 || height < 1) {
    throw std::invalid_argument("a picture of maps needs at least one map, a true path and a positive size");
  }
  sim::Picture picture;
  const auto count = static_cast<int>(maps.size());
  picture.width = count * width + (count - 1) * kPictureMargin;
  picture.height = height + 2 * kPictureMargin + kScaleHeight;
  for (int i = 0; i < picture.width * picture.height; ++i)
    picture.rgb.insert(picture.rgb.end(), kBackground.begin(), kBackground.end());
  const Camera camera(truth, width, height);
  for (int i = 0; i < count; ++i)
    draw_map(maps[static_cast<std::size_t>(i)], camera, i * (width + kPictureMargin), width, height, picture);
  const int scale_width = picture.width - 2 * kPictureMargin;
  for (int x = 0; x < scale_width; ++x) {
    const auto colour = error_colour(kMapErrorMax_m * static_cast<float>(x) / static_cast<float>(scale_width));
    for (int y = 0; y < kScaleHeight; ++y) set_pixel(picture, kPictureMargin + x, height + kPictureMargin + y, colour);
  }
  return picture;
}

}  // namespace tumble::tools
