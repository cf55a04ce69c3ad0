// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <fstream>
#include <istream>
#include <iterator>
#include <optional>
#include <string>
#include <tumble/tumble.hpp>
#include <vector>

/// driver.hpp replaces the drivers of a robot: it reads messages as lines of text, in order of time. A program of the
/// robot must write these lines; `tumble` cannot.
///
///     imu TIME_NS WX WY WZ FX FY FZ        rad/s and m/s^2, one line per IMU; several IMUs share the first one's stamp
///     sweep START_NS END_NS POINTS         then POINTS lines: X Y Z OFFSET_NS RING, metres in the lidar's axes
namespace driver {

struct Sweep {
  tumble::TimeNs start_ns = 0, end_ns = 0;
  std::vector<tumble::LidarPoint> points;
};
struct Message {
  std::optional<tumble::ImuSample> imu;  ///< or a sweep
  Sweep sweep;
};

/// Prints that the rest of the input is not read.
inline std::optional<Message> stop(const std::string& kind) {
  std::fprintf(stderr, "incomplete message '%s'; the rest is not read\n", kind.c_str());
  return std::nullopt;
}

/// Returns the next message, or nothing at the end of the input. An invalid line is reported and ends the input.
inline std::optional<Message> next(std::istream& in) {
  Message out;
  std::string kind;
  if (!(in >> kind)) return std::nullopt;
  if (kind == "imu") {
    tumble::ImuSample& imu = out.imu.emplace();
    Eigen::Vector3d &w = imu.angular_velocity_rad_s, &f = imu.specific_force_m_s2;
    in >> imu.time_ns >> w.x() >> w.y() >> w.z() >> f.x() >> f.y() >> f.z();
  } else if (kind == "sweep") {
    std::size_t count = 0;
    in >> out.sweep.start_ns >> out.sweep.end_ns >> count;
    for (tumble::LidarPoint point; in && out.sweep.points.size() < count; out.sweep.points.push_back(point)) {
      Eigen::Vector3f& p = point.position_L_m;
      in >> p.x() >> p.y() >> p.z() >> point.offset_ns >> point.ring;
    }
  } else {
    return stop(kind);
  }
  if (!in) return stop(kind);
  return out;
}

/// Passes a message to the odometry. A message that the odometry rejects is reported and left out.
inline void add(const Message& message, tumble::TumblingOdometry& odometry) {
  const Sweep& sweep = message.sweep;
  const tumble::Status status =
      message.imu ? odometry.add_imu(*message.imu) : odometry.add_sweep(sweep.start_ns, sweep.end_ns, sweep.points);
  if (!status.ok()) std::fprintf(stderr, "%s\n", status.message().c_str());
}

/// Returns all bytes of a file, or nothing if the file is missing.
inline std::vector<std::byte> read_bytes(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto* const bytes = reinterpret_cast<const std::byte*>(text.data());
  return {bytes, bytes + text.size()};
}

/// Writes all bytes or none: to a temporary file, which then replaces `file`. Returns false on failure.
inline bool write_bytes(const std::vector<std::byte>& bytes, const std::string& file) {
  const std::string beside = file + ".new";
  std::ofstream out(beside, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  out.close();
  return out && std::rename(beside.c_str(), file.c_str()) == 0;
}

/// Prints a pose as a line "TIME_NS x y z qx qy qz qw sigma_m".
inline void print(const tumble::PoseState& pose) {
  const Eigen::Vector3d& p = pose.position_W_m;
  const Eigen::Quaterniond& q = pose.orientation_W;
  std::printf("%lld %.6f %.6f %.6f %.9f %.9f %.9f %.9f %.4f\n", static_cast<long long>(pose.time_ns), p.x(), p.y(),
              p.z(), q.x(), q.y(), q.z(), q.w(), std::sqrt(pose.covariance.topLeftCorner<3, 3>().trace()));
}

/// Prints the pose at the end of a sweep, or why the sweep has no pose (for example because it starts before the IMU
/// data).
inline void print(const tumble::TumblingOdometry::Sweep& sweep) {
  if (!sweep.result.trajectory.empty()) {
    print(sweep.result.pose);
  } else {
    std::fprintf(stderr, "a sweep has no pose: %s\n", sweep.status.message().c_str());
  }
}

}  // namespace driver
