// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/estimates/map_file.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <array>
#include <bit>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/clouds/cloud_file.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/regular_file.hpp"
#include "scenarios/text.hpp"
#include "tumble/mapping/types.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"

namespace tumble::scenarios {

namespace {

static_assert(std::endian::native == std::endian::little,
              "map files are little-endian, so this code needs a little-endian processor");

constexpr std::array<const char*, 7> kProperties = {"x", "y", "z", "nx", "ny", "nz", "sigma"};
using Row = std::array<float, kProperties.size()>;

std::vector<std::string> header(std::size_t points) {
  std::vector<std::string> lines = {"ply", "format binary_little_endian 1.0",
                                    "element vertex " + std::to_string(points)};
  for (const char* name : kProperties) lines.push_back(std::string("property float ") + name);
  lines.push_back("end_header");
  return lines;
}

std::size_t read_header(std::istream& file, const std::filesystem::path& path) {
  const std::vector<std::string> expected = header(0);
  std::size_t points = 0;
  for (const std::string& line : expected) {
    std::string found;
    if (!std::getline(file, found))
      throw BadInput(fmt::format("{}: the header of the map file is truncated", path.string()));
    const std::string prefix = "element vertex ";
    if (line.starts_with(prefix) && found.starts_with(prefix) &&
        read_number(std::string_view(found).substr(prefix.size()), points))
      continue;
    if (found != line)
      throw BadInput(fmt::format("{}: a line of the map file's header is '{}'; it must be '{}'", path.string(),
                                 shortened(found), line));
  }
  return points;
}

void write_points(const std::filesystem::path& path, std::string text, std::span<const MapPoint> map) {
  OutputFile file(path);
  for (const MapPoint& point : map) {
    const Row row = {point.position_W_m.x(), point.position_W_m.y(), point.position_W_m.z(), point.normal_W.x(),
                     point.normal_W.y(),     point.normal_W.z(),     point.sigma_m};
    text.append(reinterpret_cast<const char*>(row.data()), sizeof(row));
  }
  file.write(std::as_bytes(std::span(text)));
  file.move_into_place();
}

}  // namespace

void write_map(const std::filesystem::path& path, std::span<const MapPoint> map) {
  std::string text;
  for (const std::string& line : header(map.size())) text += line + '\n';
  write_points(path, std::move(text), map);
}

void write_map_pcd(const std::filesystem::path& path, std::span<const MapPoint> map) {
  write_points(path,
               fmt::format("VERSION 0.7\nFIELDS x y z normal_x normal_y normal_z sigma\nSIZE 4 4 4 4 4 4 4\n"
                           "TYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\nWIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\n"
                           "POINTS {0}\nDATA binary\n",
                           map.size()),
               map);
}

std::vector<MapPoint> read_map(const std::filesystem::path& path) {
  std::ifstream file = open_regular_file(path);
  const std::size_t points = read_header(file, path);
  const auto data = file.tellg();
  file.seekg(0, std::ios::end);
  const auto bytes = static_cast<std::uintmax_t>(file.tellg() - data);
  if (bytes / sizeof(Row) != points || bytes % sizeof(Row) != 0) {
    throw BadInput(
        fmt::format("{}: the map file is truncated or has extra bytes: it has {} bytes of data for {} points",
                    path.string(), bytes, points));
  }
  file.seekg(data);
  std::vector<MapPoint> map(points);
  for (MapPoint& point : map) {
    Row row;
    if (!file.read(reinterpret_cast<char*>(row.data()), sizeof(row)))
      throw BadInput(path.string() + ": cannot be read");
    point.position_W_m = {row[0], row[1], row[2]};
    point.normal_W = {row[3], row[4], row[5]};
    point.sigma_m = row[6];
  }
  return map;
}

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
