// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/prior_map_file.hpp"

#include <fmt/format.h>
#include <Eigen/Core>
#include <fstream>
#include <iterator>
#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/clouds/cloud_file.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/regular_file.hpp"
#include "tumble/mapping/prior_map.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"

namespace tumble::scenarios {

namespace {

struct VectorColumns {
  const std::vector<double>*x = nullptr, *y = nullptr, *z = nullptr;

  explicit operator bool() const { return x && y && z; }
  Eigen::Vector3f operator()(std::size_t k) const { return Eigen::Vector3d((*x)[k], (*y)[k], (*z)[k]).cast<float>(); }
};

VectorColumns find(const Cloud& cloud, const std::string& prefix) {
  return {cloud.find(prefix + "x"), cloud.find(prefix + "y"), cloud.find(prefix + "z")};
}

std::vector<MapPoint> from_cloud(const std::filesystem::path& path) {
  const Cloud cloud = read_cloud(path);
  const VectorColumns position = find(cloud, "");
  if (!position) throw BadInput(fmt::format("{}: the map file has no columns x y z", path.string()));
  VectorColumns normal = find(cloud, "n");
  if (!normal) normal = find(cloud, "normal_");
  if (!normal) {
    std::vector<Eigen::Vector3f> positions(cloud.points);
    for (std::size_t k = 0; k < cloud.points; ++k) positions[k] = position(k);
    return to_map_points(positions);
  }
  const std::vector<double>* sigma = cloud.find("sigma");
  std::vector<MapPoint> points;
  for (std::size_t k = 0; k < cloud.points; ++k) {
    MapPoint point{position(k), normal(k), sigma ? static_cast<float>((*sigma)[k]) : 0.02f};
    if (!point.position_W_m.allFinite()) continue;
    if (!point.normal_W.allFinite()) point.normal_W.setZero();
    points.push_back(point);
  }
  return points;
}

}  // namespace

void write_prior_map(const std::filesystem::path& path, std::span<const MapPoint> points) {
  OutputFile file(path);
  file.write(save_map(points));
  file.move_into_place();
}

std::vector<MapPoint> read_prior_map(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  if (extension == ".pcd" || extension == ".ply") return from_cloud(path);
  std::ifstream file = open_regular_file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::vector<MapPoint> points;
  const Status status = load_map(std::as_bytes(std::span(text)), points);
  if (!status.ok())
    throw BadInput(fmt::format("{}: the map cannot be read: {}; a map must be a .tumblemap, .pcd or .ply file",
                               path.string(), status.message()));
  return points;
}

}  // namespace tumble::scenarios
