// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/bag_layout.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/stored_truth.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Points in W, as "/TRACK/points" (sensor_msgs/PointCloud2: x y z, and error_m where it is known).
struct BagCloud {
  std::vector<Eigen::Vector3f> position_W_m;
  std::vector<float> error_m;  ///< parallel, or empty
};

/// Somebody's poses of the body in W, as they stand in a bag: "/NAME" (nav_msgs/Odometry) and /tf.
struct BagTrack {
  struct Pose {
    std::int64_t time_ns = 0;
    Eigen::Vector3d p_WB_m = Eigen::Vector3d::Zero();
    Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
    Eigen::Vector3d v_WB_B_m_s = Eigen::Vector3d::Zero(), w_WB_B_rad_s = Eigen::Vector3d::Zero();
    /// Of (position in W, attitude error phi in W), as in PoseState; zero where nobody states one.
    Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  };
  std::string name;  ///< letters, digits and _
  std::vector<Pose> poses;
  std::vector<std::int64_t> cloud_time_ns = {};  ///< of clouds along it
  /// Makes the cloud of a number when its turn has come, so that one at a time is in memory; without points it is left
  /// out of the bag.
  std::function<BagCloud(const BagTrack&, std::size_t)> cloud = {};
};

/// How a recording is written as a bag.
struct BagWriting {
  std::int64_t origin_ns = 0;  ///< stamp of time 0; 0: 1 000 000 000 s after 1970, since ROS takes 0 for no time
  const StoredTruth* truth = nullptr;  ///< written only when given
  std::vector<BagTrack> tracks = {};   ///< estimates; names differ from each other and from export_names' `taken`
  SweepLayout sweeps = own_sweep_layout();
  /// Of each lidar, where its points are set aside; null: they are in the records.
  const std::vector<PointStore>* points = nullptr;
  std::optional<ReaderNames> names = {};  ///< given: the first IMU and the first lidar alone, under these
  bool empty_sweeps = true;               ///< false: those without a point are left out
};

/// The stamp of time 0 in a bag, ns since 1970: `origin_ns`, or the default above where that is 0.
std::int64_t bag_origin_ns(const BagWriting& writing);

/// Writes a recording as a ROS 1 bag (version 2.0, by librosbag), as a ROS 2 bag: a folder with metadata.yaml (version
/// 5) and a SQLite file of CDR messages with their definitions (schema 4, as since Iron), or as an MCAP file of profile
/// ros2 (mcap.dev/spec: chunks of 1 MiB packed by LZ4, indexed, every checksum there is). In all of them:
///
/// - "/NAME" (sensor_msgs/Imu; without attitude; white noise of the data sheet as covariance), NAME the sensor's by
///   export_names; of several the primary one is the first topic of its type;
/// - "/NAME/points" (sensor_msgs/PointCloud2, stamped at the sweep's start, with the fields that drivers of Velodyne
///   give: x y z intensity ring time, the time float32 seconds after the stamp, to 4 ns within 0.1 s; and offset_ns,
///   the same in whole nanoseconds; neither where points have no times; or what `sweeps` says);
/// - "/truth" (nav_msgs/Odometry of "body" in "world", every 5 ms at most), "/TRACK" and "/TRACK/points";
/// - "/tf_static": each sensor in "body", by the calibration that an estimator is given; "/tf": "body" in "world" by
/// the
///   truth, without it by the first track; other tracks move a frame "TRACK" instead;
/// - "/clock" (rosgraph_msgs/Clock), with the first message after every 10 ms.
///
/// Throws BadInput when the place cannot be written.
void export_ros1_bag(const sim::Sensors& sensors, const BagWriting& writing, const std::filesystem::path& file);
void export_ros2_bag(const sim::Sensors& sensors, const BagWriting& writing, const std::filesystem::path& folder);
void export_mcap(const sim::Sensors& sensors, const BagWriting& writing, const std::filesystem::path& file);
/// The same MCAP file in a folder with metadata.yaml, as ROS 2 itself has them since Iron.
void export_ros2_mcap(const sim::Sensors& sensors, const BagWriting& writing, const std::filesystem::path& folder);

/// Which stamp of a message counts: its header's, of whoever measured; or the record's, of when the bag took it, for
/// headers without usable stamps. A sweep is recorded when it is over: then it starts a period before.
enum class StampSource { header, record };

/// Whose poses a reference holds: that of the frame that its messages name, where the bag places it; the body's; the
/// first lidar's.
enum class ReferenceOf { named, body, lidar };

/// What is taken from a bag.
struct BagReading {
  std::vector<std::string> imu_topics;    ///< the first is the primary one; empty: all of type Imu, as they stand
  std::vector<std::string> lidar_topics;  ///< empty: all of type PointCloud2 or CustomMsg
  std::string reference_topic;            ///< Odometry or PoseStamped; "": none
  ReferenceOf reference_of = ReferenceOf::named;
  sim::ImuRecord imu;                   ///< what the messages do not state: device, ranges, noise, T_BI
  std::optional<AccelUnit> accel_unit;  ///< none: sensor_msgs/Imu's m/s^2, or g where the readings are
  GyroUnit gyro_unit = GyroUnit::rad_s;
  StampSource stamps = StampSource::header;
  SweepReading sweeps;
};

/// Reads a ROS 1 bag (not encrypted), a ROS 2 bag: its folder (SQLite or MCAP, plain or
/// packed by Zstandard, file by file or message by message), or its SQLite file, or an MCAP file
/// with messages of ROS 2 (cdr) or ROS 1 in chunks that are plain or packed by LZ4 or Zstandard; indexed or not. Times
/// are those of `stamps`; how headers and records differ is said in the notes. Units are held against gravity as of a
/// CSV; specific force that is in g by its size at rest, as Livox' drivers give it, is read so and said. With
/// `sweeps.scratch` in memory are a sweep at a time, what the IMUs said (57 bytes a sample) and some bytes a message;
/// without it all. Sensors bear the name of their topic. Points as import_sweeps takes them; without a choice of topics
/// a cloud in "world", "map" or "odom" is left out, since no sensor's points lie there. Where /tf_static places a
/// sensor in "body" or "base_link", or, without such a frame, beside another sensor, and nothing else was given, that
/// is its pose. A message that is there twice, stamp and content, is taken once. Throws BadInput with file and place:
/// damaged, truncated, a topic that is not there or of another type, a message whose stamp does not rise, frames that
/// hang on each other in a ring.
Imported import_ros1_bag(const std::filesystem::path& file, const BagReading& reading);
Imported import_ros2_bag(const std::filesystem::path& path, const BagReading& reading);
Imported import_mcap(const std::filesystem::path& file, const BagReading& reading);

}  // namespace tumble::scenarios
