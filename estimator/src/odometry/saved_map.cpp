// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/odometry/tumbling_odometry.hpp"

#include "saved_bytes.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble {

namespace {

constexpr std::size_t kPointBytes = 28;

template <class Visit, class Point>
void visit_point(Visit& visit, Point& point) {
  visit("point.position_W_m", point.position_W_m);
  visit("point.normal_W", point.normal_W);
  visit("point.sigma_m", point.sigma_m);
}

}  // namespace

std::vector<std::byte> save_map(std::span<const MapPoint> points) {
  odometry::SavedStateWriter out;
  out.reserve(sizeof(std::uint64_t) + kPointBytes * points.size());
  out("map.points", std::uint64_t{points.size()});
  for (const MapPoint& point : points) visit_point(out, point);
  return std::move(out).finish(odometry::SavedStateKind::map);
}

Status load_map(std::span<const std::byte> bytes, std::vector<MapPoint>& points) {
  odometry::SavedStateReader in(odometry::SavedStateKind::map, bytes);
  std::uint64_t count = 0;
  in("map.points", count);
  in.require_condition(
      "map.points",
      in.remaining_bytes().size() % kPointBytes == 0 && count == in.remaining_bytes().size() / kPointBytes,
      double(count), double(in.remaining_bytes().size()) / kPointBytes);
  if (!in.status().ok()) return in.status();
  std::vector<MapPoint> loaded(count);
  for (MapPoint& point : loaded) visit_point(in, point);
  if (!in.status().ok()) return in.status();
  if (const Status status = check_map_points(loaded); !status.ok()) return status;
  points = std::move(loaded);
  return {};
}

}  // namespace tumble
