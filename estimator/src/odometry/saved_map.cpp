// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/odometry/detail/saved_map.hpp"

#include "../mapping/odometry_members.hpp"
#include "saved_state.hpp"

namespace tumble {

namespace {

std::uint64_t layout_of_map() {
  StateLayout layout;
  const std::vector<MapPoint> points;
  layout("map.points", points);
  return layout.digest();
}

}  // namespace

std::vector<std::byte> save_map(std::span<const MapPoint> points) {
  std::vector<std::byte> bytes(odometry::kSavedHeader);
  StateWriter out(bytes);
  out.length("map.points", points.size());
  for (const MapPoint& point : points) out("map.point", point);
  odometry::seal(odometry::SavedKind::map, layout_of_map(), bytes);
  return bytes;
}

Status load_map(std::span<const std::byte> bytes, std::vector<MapPoint>& points) {
  std::span<const std::byte> payload;
  if (const Status status = odometry::open(odometry::SavedKind::map, layout_of_map(), bytes, payload); !status.ok())
    return status;
  PriorMap map;
  StateReader in(payload);
  in("map.points", map.points);
  in.require("bytes after the map", in.left().empty(), double(in.left().size()), 0.0);
  if (!in.status().ok()) return in.status();
  if (const Status status = check_map_points(map.points); !status.ok()) return status;
  points = std::move(map.points);
  return {};
}

}  // namespace tumble
