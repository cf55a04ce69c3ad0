// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/saved_runs.hpp"

#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <tumble/tumble.hpp>

#include "estimator/src/odometry/saved_bytes.hpp"
#include "scenarios/errors.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"

namespace tumble::fuzz {

namespace {

using Bytes = std::vector<std::byte>;
using odometry::SavedStateKind;

ImuSample sample_at(int k) {
  ImuSample out;
  out.time_ns = k * TimeNs{10'000'000};
  const double turn = k < 12 ? 0.0 : 0.3 * (k - 12);
  out.angular_velocity_rad_s = {0.2 * turn, turn, -0.1 * turn};
  out.specific_force_m_s2 = {0.1 * turn, 0.0, 9.8};
  return out;
}

/// Returns points of a floor and a wall.
std::vector<LidarPoint> some_points() {
  std::vector<LidarPoint> out;
  for (int k = 0; k < 400; ++k) {
    LidarPoint& point = out.emplace_back();
    const float a = 0.0157f * static_cast<float>(k);
    point.position_L_m = k % 2 == 0 ? Eigen::Vector3f(2.0f + 0.005f * static_cast<float>(k), 3.0f * std::sin(a), -1.0f)
                                    : Eigen::Vector3f(4.0f, 3.0f * std::sin(a), std::cos(a));
    point.offset_ns = static_cast<std::uint32_t>(100'000 * k);
    point.ring = static_cast<std::uint16_t>(k % 4);
  }
  return out;
}

TumblingOdometry tumbling() {
  TumblingOdometry::Params params;
  params.lever_arm_I_m.setZero();
  params.lag_s = 0.03;
  return TumblingOdometry(params);
}

RollingOdometry rolling() {
  RollingOdometry::Params params;
  params.radius_m = 0.145;
  params.lag_s = 0.1;
  params.imus.resize(1);
  return RollingOdometry(params);
}

void feed(TumblingOdometry& odometry) {
  for (int k = 1; k < 20; ++k) (void)odometry.add_imu(sample_at(k));
  const std::vector<LidarPoint> points = some_points();
  for (const TimeNs start_ns : {TimeNs{30'000'000}, TimeNs{80'000'000}, TimeNs{140'000'000}})
    (void)odometry.add_sweep(start_ns, start_ns + 50'000'000, points);
  PoseState pose;
  (void)odometry.newest(pose);
  while (odometry.take()) continue;
}

void feed(RollingOdometry& odometry) {
  for (int k = 1; k < 40; ++k) (void)odometry.add_imu(sample_at(k));
  while (odometry.take()) continue;
}

Bytes sealed(SavedStateKind kind, std::span<const std::byte> contents) {
  odometry::SavedStateWriter out;
  out.append_bytes(contents);
  return std::move(out).finish(kind);
}

void refuse(const Status& status) {
  if (!status.ok()) throw scenarios::BadInput(status.message());
}

/// A rejected run must leave the object unchanged. An accepted run must continue, and must load again.
template <class Odometry>
void load_and_continue(const Bytes& bytes, Odometry odometry) {
  const Bytes before = odometry.save();
  const Status status = odometry.load(bytes);
  if (!status.ok() && odometry.save() != before) throw std::logic_error("a rejected run changed the object");
  refuse(status);
  if (const Status again = odometry.load(odometry.save()); !again.ok()) throw std::logic_error(again.message());
  feed(odometry);
}

std::string seed(char letter, const Bytes& bytes) {
  const std::span<const std::byte> contents = std::span(bytes).subspan(odometry::kSavedHeader);
  std::string out(1, letter);
  for (const std::byte byte : contents) out.push_back(static_cast<char>(byte));
  return out;
}

}  // namespace

void saved_run(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (text.empty()) throw scenarios::BadInput("the file is empty");
  const std::span<const std::byte> contents = std::as_bytes(std::span(text)).subspan(1);
  std::vector<MapPoint> points;
  switch (text[0]) {
    case 'T':
      return load_and_continue(sealed(SavedStateKind::tumbling, contents), tumbling());
    case 'R':
      return load_and_continue(sealed(SavedStateKind::rolling, contents), rolling());
    case 'M':
      return refuse(load_map(sealed(SavedStateKind::map, contents), points));
    default:
      throw scenarios::BadInput("none of T, R and M");
  }
}

std::vector<std::pair<std::string, std::string>> saved_run_seeds() {
  TumblingOdometry tumbled = tumbling();
  RollingOdometry rolled = rolling();
  std::vector<std::pair<std::string, std::string>> out{{"tumbling_new", seed('T', tumbled.save())},
                                                       {"rolling_new", seed('R', rolled.save())}};
  feed(tumbled);
  feed(rolled);
  const std::vector<MapPoint> points = tumbled.mapper().map();
  out.emplace_back("tumbling", seed('T', tumbled.save()));
  out.emplace_back("rolling", seed('R', rolled.save()));
  out.emplace_back("map", seed('M', save_map(std::span(points).first(std::min<std::size_t>(points.size(), 20)))));
  out.emplace_back("refused_kind", seed('T', rolled.save()));
  return out;
}

}  // namespace tumble::fuzz
