// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/bags/bag_imu.hpp"

#include <fmt/format.h>

#include <utility>

#include "scenarios/recordings/bags/bag_messages.hpp"
#include "scenarios/recordings/tables/imu_readings.hpp"

namespace tumble::scenarios {

namespace {

AccelUnit take_in_g(const std::string& topic, const BagReading& reading, sim::ImuRecord& imu,
                    std::vector<std::string>& notes) {
  if (reading.accel_unit || !is_in_g(imu)) return reading.accel_unit.value_or(AccelUnit::m_s2);
  for (Eigen::Vector3d& force : imu.accel_m_s2) force *= scale_of(AccelUnit::g);
  notes.push_back(
      fmt::format("{}: caution: sensor_msgs/Imu requires m/s^2, but the specific force at rest is about 1. The import "
                  "therefore reads the accelerometer in g (set '--accel-unit m/s^2' to read m/s^2)",
                  topic));
  return AccelUnit::g;
}

}  // namespace

std::string repeats_text(std::size_t repeated) {
  if (repeated == 0) return "";
  return fmt::format("the import left out {} duplicate messages, which have the stamp and content of another message",
                     repeated);
}

ImuTopic read_imu(const OpenedBag& bag, SensorMountings& places, const std::string& topic, const BagReading& reading,
                  std::vector<std::string>& notes) {
  sim::ImuRecord imu = without_readings(reading.imu);
  imu.name = reading.for_odometry ? topic : sensor_name(topic);
  std::string frame;
  BagStamps stamps(reading.stamps);
  LeftOut left_out("readings");
  const double force_scale = scale_of(reading.accel_unit.value_or(AccelUnit::m_s2));
  ros::Imu before;
  std::size_t repeated = 0;
  std::vector<std::size_t> numbers;
  const auto take = [&](const ros::Imu& message, const MessageOrigin& origin) {
    const std::int64_t header_ns = stamp_of(message.header);
    if (stamps.repeats(header_ns) && message.angular_velocity == before.angular_velocity &&
        message.linear_acceleration == before.linear_acceleration) {
      ++repeated;
      return;
    }
    add_reading(origin.where, stamps.chosen(header_ns, origin.record_ns, origin.where),
                scale_of(reading.gyro_unit) * Eigen::Vector3d::Map(message.angular_velocity.data()),
                force_scale * Eigen::Vector3d::Map(message.linear_acceleration.data()), imu);
    stamps.add(header_ns, origin.record_ns);
    numbers.push_back(origin.number);
    frame = without_slash(message.header.frame_id);
    before = message;
  };
  bag.read<ros::Imu>(
      topic,
      [&](const ros::Imu& message, const MessageOrigin& origin) { left_out.guard([&] { take(message, origin); }); },
      &left_out);
  const std::string where = bag.place + ": topic " + topic;
  if (imu.time_ns.empty() && left_out.count() == 0 && reading.imu_topics.empty()) return {imu};
  const std::string bursts = leave_out_faulty([&](std::size_t k) { return bag.place_of(topic, numbers[k]); },
                                              [&](std::size_t k) { return stamps.disorder(k); }, left_out, imu);
  const std::string lost = left_out.note(imu.time_ns.size());
  const AccelUnit accel_unit = take_in_g(topic, reading, imu, notes);
  finish_readings(where, accel_unit, imu);
  const std::string evened = even_out_stamps(imu);
  const std::string units = rates_text(where, imu, reading.gyro_unit);
  for (const std::string& remark :
       {lost, bursts, evened, gaps_text(imu), units, stamps.remark(), repeats_text(repeated)}) {
    if (!remark.empty()) notes.push_back(topic + ": " + remark);
  }
  // The command-line option --lever-arm states only the position of the IMU, so the orientation of the IMU comes from
  // /tf_static.
  if (const auto stated = places.of(frame); stated && reading.imu_placed && imu.T_BI.linear().isIdentity())
    imu.T_BI.linear() = stated->linear();
  places.place(topic, frame, "--lever-arm", reading.imu_placed, imu.T_BI, notes);
  return {std::move(imu), stamps.lag_ns().first};
}

}  // namespace tumble::scenarios
