// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstring>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/export_folder.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::int64_t kOrigin_ns = 1000000000ll * 1000000000ll;
constexpr std::int64_t kTruthStep_ns = 5000000;
constexpr const char* kTruthTopic = "/truth";

template <std::size_t kCount, class Vector>
std::array<double, kCount> array_of(const Vector& vector) {
  std::array<double, kCount> out;
  std::copy(vector.data(), vector.data() + kCount, out.begin());
  return out;
}

ros::Header header_of(std::int64_t stamp_ns, const std::string& frame) {
  constexpr std::int64_t kSecond_ns = 1000000000;
  return {0, static_cast<std::uint32_t>(stamp_ns / kSecond_ns), static_cast<std::uint32_t>(stamp_ns % kSecond_ns),
          frame};
}

/// White noise of one sample: density squared times the bandwidth of the output rate.
std::array<double, 9> covariance_of(double density_sqrt_hz, std::int64_t period_ns) {
  const double variance = density_sqrt_hz * density_sqrt_hz / (static_cast<double>(period_ns) * 1e-9);
  return {variance, 0, 0, 0, variance, 0, 0, 0, variance};
}

ros::Imu imu_message(const sim::ImuRecord& imu, std::size_t i, const ros::Header& header) {
  ros::Imu out;
  out.header = header;
  out.angular_velocity = array_of<3>(imu.gyro_rad_s[i]);
  out.angular_velocity_covariance = covariance_of(imu.gyro_noise_rad_s_sqrt_hz, imu.period_ns);
  out.linear_acceleration = array_of<3>(imu.accel_m_s2[i]);
  out.linear_acceleration_covariance = covariance_of(imu.accel_noise_m_s2_sqrt_hz, imu.period_ns);
  return out;
}

/// The layout of Velodyne's driver.
ros::PointCloud2 cloud_message(const sim::LidarRecord& lidar, std::size_t sweep, const ros::Header& header) {
  const std::size_t first = lidar.sweep_first[sweep], count = lidar.sweep_first[sweep + 1] - first;
  const bool timed = lidar.point_times == sim::PointTimes::measured;
  using Field = ros::PointField;
  ros::PointCloud2 out;
  out.header = header;
  out.fields = {{"x", 0, Field::float32, 1},
                {"y", 4, Field::float32, 1},
                {"z", 8, Field::float32, 1},
                {"intensity", 12, Field::float32, 1},
                {"ring", 16, Field::uint16, 1}};
  if (timed) out.fields.push_back({"time", 18, Field::float32, 1});
  out.point_step = timed ? 22 : 18;
  out.width = static_cast<std::uint32_t>(count);
  out.row_step = out.width * out.point_step;
  out.data.resize(out.row_step);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint8_t* at = out.data.data() + i * out.point_step;
    const std::size_t k = first + i;
    const float numbers[4] = {lidar.position_L_m[k].x(), lidar.position_L_m[k].y(), lidar.position_L_m[k].z(),
                              lidar.intensity[k]};
    std::memcpy(at, numbers, sizeof(numbers));
    std::memcpy(at + 16, &lidar.ring[k], sizeof(lidar.ring[k]));
    const float time_s = static_cast<float>(lidar.offset_ns[k] * 1e-9);
    if (timed) std::memcpy(at + 18, &time_s, sizeof(time_s));
  }
  return out;
}

ros::Odometry truth_message(const sim::Truth& truth, std::size_t i, const ros::Header& header) {
  const Eigen::Vector3d v_B = truth.q_WB[i].conjugate() * truth.v_WB_m_s[i];
  ros::Odometry out;
  out.header = header;
  out.child_frame_id = "body";
  out.position = array_of<3>(truth.p_WB_m[i]);
  out.orientation_xyzw = array_of<4>(truth.q_WB[i].coeffs());
  out.linear_velocity = array_of<3>(v_B);
  out.angular_velocity = array_of<3>(truth.w_WB_B_rad_s[i]);
  return out;
}

/// What is to be written, and when a listener would have it: a sweep when it is over.
struct Event {
  enum Kind { imu, sweep, pose };
  std::int64_t time_ns;
  Kind kind;
  std::size_t sensor, index;
};

std::vector<Event> events_of(const sim::Sensors& sensors, const sim::Truth* truth) {
  std::vector<Event> events;
  for (std::size_t s = 0; s < sensors.imus.size(); ++s) {
    const std::vector<std::int64_t>& times = sensors.imus[s].time_ns;
    for (std::size_t i = 0; i < times.size(); ++i) events.push_back({times[i], Event::imu, s, i});
  }
  for (std::size_t s = 0; s < sensors.lidars.size(); ++s) {
    const sim::LidarRecord& lidar = sensors.lidars[s];
    for (std::size_t i = 0; i < lidar.sweep_start_ns.size(); ++i) {
      events.push_back({lidar.sweep_start_ns[i] + lidar.sweep_period_ns, Event::sweep, s, i});
    }
  }
  if (truth != nullptr) {
    const std::int64_t step = std::max<std::int64_t>(kTruthStep_ns / truth->period_ns, 1);
    for (std::size_t i = 0; i < truth->p_WB_m.size(); i += static_cast<std::size_t>(step)) {
      if (!truth->p_WB_m[i].allFinite() || !truth->q_WB[i].coeffs().allFinite()) continue;
      events.push_back({static_cast<std::int64_t>(i) * truth->period_ns, Event::pose, 0, i});
    }
  }
  std::stable_sort(events.begin(), events.end(), [](const Event& a, const Event& b) { return a.time_ns < b.time_ns; });
  return events;
}

void write_bag(const sim::Sensors& sensors, const BagWriting& writing, BagWriter& bag) {
  const std::int64_t origin = writing.origin_ns != 0 ? writing.origin_ns : kOrigin_ns;
  if (origin < 0) throw BadInput("the recording begins before 1970: a bag has no such stamps");
  for (const Event& event : events_of(sensors, writing.truth)) {
    const std::int64_t stamp = origin + event.time_ns;
    if (stamp < 0) throw BadInput("a reading lies before 1970: a bag has no such stamps");
    if (event.kind == Event::imu) {
      const sim::ImuRecord& imu = sensors.imus[event.sensor];
      const std::string stem = file_stem(imu.name, "imu", event.sensor);
      bag.write({"/" + stem, "sensor_msgs/Imu"}, stamp, imu_message(imu, event.index, header_of(stamp, stem)));
    } else if (event.kind == Event::sweep) {
      const sim::LidarRecord& lidar = sensors.lidars[event.sensor];
      const std::string stem = file_stem(lidar.name, "lidar", event.sensor);
      const ros::Header header = header_of(origin + lidar.sweep_start_ns[event.index], stem);
      bag.write({"/" + stem + "/points", "sensor_msgs/PointCloud2"}, stamp, cloud_message(lidar, event.index, header));
    } else {
      bag.write({kTruthTopic, "nav_msgs/Odometry"}, stamp,
                truth_message(*writing.truth, event.index, header_of(stamp, "world")));
    }
  }
  bag.finish();
}

}  // namespace

void export_ros1_bag(const sim::Sensors& sensors, const BagWriting& writing, const std::filesystem::path& file) {
  write_bag(sensors, writing, *make_ros1_writer(file));
}

void export_ros2_bag(const sim::Sensors& sensors, const BagWriting& writing, const std::filesystem::path& folder) {
  write_bag(sensors, writing, *make_ros2_writer(folder));
}

}  // namespace tumble::scenarios
