// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/saved_states.hpp"

#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <tumble/tumble.hpp>
#include <vector>
#include "estimator/src/common/state_bytes.hpp"

#include "scenarios/errors.hpp"

namespace tumble::fuzz {

namespace {

using Bytes = std::vector<std::byte>;

constexpr std::size_t kHeader = 40, kLengthAt = 24, kChecksumAt = 32, kEdit = 6;

void put_number(std::uint64_t value, std::size_t at, Bytes& bytes) {
  for (std::size_t k = 0; k < 8; ++k) bytes[at + k] = static_cast<std::byte>(value >> (8 * k));
}

void reseal(Bytes& bytes) {
  put_number(bytes.size() - kHeader, kLengthAt, bytes);
  const std::span<const std::byte> all(bytes);
  put_number(checksum(all.subspan(kHeader), checksum(all.first(kChecksumAt))), kChecksumAt, bytes);
}

/// Of numbers, lengths, flags and enumerations.
constexpr std::uint64_t kNumbers[] = {0,
                                      1,
                                      2,
                                      0xffffffffu,
                                      0x7fffffffffffffffu,
                                      0xffffffffffffffffu,
                                      0x8000000000000000u,
                                      0x7ff0000000000000u,
                                      0x7ff8000000000000u,
                                      0x7fe0000000000000u,
                                      0x7f8000007f800000u};

void edit(std::span<const unsigned char> how, Bytes& bytes) {
  const std::uint32_t where = how[1] | how[2] << 8u | how[3] << 16u | std::uint32_t{how[4]} << 24u;
  const std::size_t room = bytes.size() - kHeader;
  if (room < 9) return;
  const std::size_t at = kHeader + where % (room - 8);
  const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
  switch (how[0] % 5) {
    case 0:
      *place = static_cast<std::byte>(how[5]);
      return;
    case 1:
      *place ^= static_cast<std::byte>(how[5]);
      return;
    case 2:
      put_number(kNumbers[how[5] % std::size(kNumbers)], at, bytes);
      return;
    case 3:
      bytes.erase(place, place + 1 + how[5] % 8);
      return;
    default:
      bytes.insert(place, 1 + how[5] % 8, std::byte{0});
  }
}

ImuSample sample_at(int k) {
  ImuSample out;
  out.time_ns = k * TimeNs{10'000'000};
  const double turn = k < 12 ? 0.0 : 0.3 * (k - 12);
  out.angular_velocity_rad_s = {0.2 * turn, turn, -0.1 * turn};
  out.specific_force_m_s2 = {0.1 * turn, 0.0, 9.8};
  return out;
}

/// A floor and a wall.
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
Bytes saved_tumbling() {
  TumblingOdometry odometry = tumbling();
  for (int k = 1; k < 20; ++k) (void)odometry.add_imu(sample_at(k));
  const std::vector<LidarPoint> points = some_points();
  for (const TimeNs start_ns : {TimeNs{30'000'000}, TimeNs{80'000'000}, TimeNs{140'000'000}})
    (void)odometry.add_sweep(start_ns, start_ns + 50'000'000, points);
  return odometry.save();
}
void go_on(TumblingOdometry& odometry) {
  for (int k = 20; k < 23; ++k) (void)odometry.add_imu(sample_at(k));
  PoseState pose;
  (void)odometry.newest(pose);
  while (odometry.take()) continue;
}

RollingOdometry rolling() {
  RollingOdometry::Params params;
  params.radius_m = 0.145;
  params.lag_s = 0.1;
  params.units.resize(1);
  return RollingOdometry(params);
}
Bytes saved_rolling() {
  RollingOdometry odometry = rolling();
  for (int k = 1; k < 20; ++k) (void)odometry.add_imu(sample_at(k));
  return odometry.save();
}
void go_on(RollingOdometry& odometry) {
  for (int k = 20; k < 40; ++k) (void)odometry.add_imu(sample_at(k));
  while (odometry.take()) continue;
}

template <class Door>
void load(Door door, Bytes bytes, std::span<const unsigned char> edits) {
  for (; edits.size() >= kEdit; edits = edits.subspan(kEdit)) edit(edits, bytes);
  if (!edits.empty()) throw scenarios::BadInput("half an edit");
  reseal(bytes);
  const Status status = door.load(bytes);
  if (!status.ok()) throw scenarios::BadInput(status.message());
  if (door.save() != bytes) throw std::logic_error("a state that was loaded is another one when it is saved");
  go_on(door);
}

}  // namespace

void saved_states(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const std::span<const unsigned char> bytes(reinterpret_cast<const unsigned char*>(text.data()), text.size());
  if (bytes.empty() || (bytes[0] != 'T' && bytes[0] != 'R')) throw scenarios::BadInput("neither T nor R");
  if (bytes[0] == 'T') {
    static const Bytes saved = saved_tumbling();
    load(tumbling(), saved, bytes.subspan(1));
  } else {
    static const Bytes saved = saved_rolling();
    load(rolling(), saved, bytes.subspan(1));
  }
}

}  // namespace tumble::fuzz
