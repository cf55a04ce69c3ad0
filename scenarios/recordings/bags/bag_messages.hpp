// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/ros_messages.hpp"

namespace tumble::scenarios {

ros::Header header_of(std::int64_t stamp_ns, const std::string& frame);
ros::Clock clock_message(std::int64_t stamp_ns);

ros::Imu imu_message(const sim::ImuRecord& imu, std::size_t i, const ros::Header& header);

ros::PointCloud2 cloud_message(const BagCloud& cloud, const ros::Header& header);

ros::Odometry odometry_message(const BagTrack::Pose& pose, const std::string& child, const ros::Header& header);
ros::TransformStamped transform_message(const Eigen::Vector3d& p, const Eigen::Quaterniond& q, const std::string& child,
                                        const ros::Header& header);

std::int64_t stamp_of(const ros::Header& header);

class BagStamps {
 public:
  explicit BagStamps(StampSource source) : source_(source) {}

  std::int64_t chosen(std::int64_t header_ns, std::int64_t record_ns, const std::string& where) const;
  void add(std::int64_t header_ns, std::int64_t record_ns);
  const std::vector<std::int64_t>& times_ns() const { return source_ == StampSource::header ? header_ns_ : record_ns_; }
  std::string disorder(std::size_t k) const;

  bool repeats(std::int64_t header_ns) const {
    return source_ == StampSource::header && !header_ns_.empty() && header_ns_.back() == header_ns;
  }

  /// Describes the delay from header stamps to record stamps of the messages. The text is empty if the delay stays
  /// below one millisecond.
  std::string remark() const;
  /// Returns true if the header stamps of messages are later than the record stamps, or at least one second earlier.
  bool other_clock() const;
  /// Returns the smallest and the largest delay from header stamp to record stamp.
  std::pair<std::int64_t, std::int64_t> lag_ns() const;

 private:
  StampSource source_;
  std::vector<std::int64_t> header_ns_, record_ns_;
};

}  // namespace tumble::scenarios
