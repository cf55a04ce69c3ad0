// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/estimates/map_file.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <bit>
#include <fstream>
#include <iterator>
#include <span>
#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/regular_file.hpp"
#include "tumble/mapping/types.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"
#include "tumble_ros/map_file.hpp"

namespace tumble::scenarios {

namespace {

static_assert(std::endian::native == std::endian::little,
              "map files are little-endian, so this code needs a little-endian processor");

void write_file(const std::filesystem::path& path, std::span<const std::byte> contents) {
  OutputFile file(path);
  file.write(contents);
  file.move_into_place();
}

}  // namespace

void write_map(const std::filesystem::path& path, std::span<const MapPoint> map) {
  const std::string ply = tumble::ros::ply_of(map);
  write_file(path, std::as_bytes(std::span(ply)));
}

/// The rows of a PCD file with these fields equal the rows of the PLY file.
void write_map_pcd(const std::filesystem::path& path, std::span<const MapPoint> map) {
  const std::string ply = tumble::ros::ply_of(map), end = "end_header\n";
  const std::string pcd = fmt::format(
                              "VERSION 0.7\nFIELDS x y z normal_x normal_y normal_z sigma\nSIZE 4 4 4 4 4 4 4\n"
                              "TYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\nWIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\n"
                              "POINTS {0}\nDATA binary\n",
                              map.size()) +
                          ply.substr(ply.find(end) + end.size());
  write_file(path, std::as_bytes(std::span(pcd)));
}

void write_prior_map(const std::filesystem::path& path, std::span<const MapPoint> points) {
  write_file(path, save_map(points));
}

std::vector<MapPoint> read_map(const std::filesystem::path& path) {
  std::ifstream file = open_regular_file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::vector<MapPoint> points;
  const Status status = tumble::ros::read_map(std::as_bytes(std::span(text)), points);
  if (!status.ok())
    throw BadInput(fmt::format("{}: the map cannot be read: {}; a map must be a .tumblemap, .pcd or .ply file",
                               path.string(), status.message()));
  return points;
}

}  // namespace tumble::scenarios
