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

#include "scenarios/not_finite.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/stored_truth.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// BagCloud is a point cloud of an estimate, written to the topic "/TRACK/points" (sensor_msgs/PointCloud2: x y z, and
/// error_m if known).
struct BagCloud {
  std::vector<Eigen::Vector3f> position_W_m;
  std::vector<float> error_m;  ///< parallel to `position_W_m`, or empty
};

/// BagTrack is a series of body poses in the world frame W, which becomes the topic "/NAME" (nav_msgs/Odometry) and a
/// part of /tf.
struct BagTrack {
  struct Pose {
    std::int64_t time_ns = 0;
    Eigen::Vector3d p_WB_m = Eigen::Vector3d::Zero();
    Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
    Eigen::Vector3d v_WB_B_m_s = kUnknown, w_WB_B_rad_s = kUnknown;
    /// Covariance of position and attitude error in world axes, as in PoseState; a block of zeros means an unknown
    /// covariance.
    Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
    bool exact = false;  ///< true: zero covariance means exact
    inline static const Eigen::Vector3d kUnknown = Eigen::Vector3d::Constant(kNaN);
  };
  std::string name;  ///< letters, digits and _
  std::vector<Pose> poses;
  std::vector<std::int64_t> cloud_time_ns = {};  ///< times of point clouds along the track
  /// The exporter calls cloud() with the index of a point cloud when the exporter writes this point cloud. Point clouds
  /// without points are omitted.
  std::function<BagCloud(const BagTrack&, std::size_t)> cloud = {};
};

struct BagWriting {
  std::int64_t origin_ns = 0;          ///< added to all times; see export_origin_ns
  const StoredTruth* truth = nullptr;  ///< true motion; null: not written
  std::vector<BagTrack> tracks = {};   ///< estimates with unique names
  SweepLayout sweeps = own_sweep_layout();
  const std::vector<PointStore>* points = nullptr;
  std::optional<ReaderNames> names = {};  ///< writes only the first IMU and lidar
  bool empty_sweeps = true;               ///< false: omits sweeps without points
};

/// The bag formats have these versions:
///
/// - The ROS 1 format is version 2.0, written by librosbag.
/// - The ROS 2 format is a folder with metadata.yaml (version 5) and a SQLite file (schema 4, as in ROS 2 Iron and
///   later).
/// - The MCAP format is a file with profile ros2 (mcap.dev/spec), with indexed LZ4 chunks of 1 MiB and all checksums.
///
/// All bags contain these topics:
///
/// - "/NAME" is a sensor_msgs/Imu without attitude, with the white noise of the data sheet as covariance. NAME is the
///   exported name of the sensor (export_names). The topic of the primary IMU comes before the topics of other IMUs.
/// - "/NAME/points" is a sensor_msgs/PointCloud2, stamped at the start of the sweep, with the fields of Velodyne
///   drivers: x y z intensity ring time. The field `time` contains the time of a point in float32 seconds after the
///   stamp, with a rounding error of at most 4 ns within 0.1 s. The field `offset_ns` contains the same time in whole
///   nanoseconds. The fields `time` and `offset_ns` are missing if the points have no times.
/// - "/truth" is a nav_msgs/Odometry of "body" in "world", at most every 5 ms. "/TRACK" and "/TRACK/points" contain
///   estimates. Unknown values have the variance -1, as in sensor_msgs/Imu; an unknown twist is zero.
/// - "/tf_static" contains the pose of each sensor in "body", from the calibration that the estimator uses.
/// - "/tf" contains the pose of "body" in "world" from the truth or, if there is no truth, from the first track.
/// - "/clock" is a rosgraph_msgs/Clock, published with the first message after every 10 ms.
void export_ros1_bag(const sim::Sensors& sensors, const BagWriting& writing, const std::filesystem::path& file);
void export_ros2_bag(const sim::Sensors& sensors, const BagWriting& writing, const std::filesystem::path& folder);
void export_mcap(const sim::Sensors& sensors, const BagWriting& writing, const std::filesystem::path& file);
void export_ros2_mcap(const sim::Sensors& sensors, const BagWriting& writing, const std::filesystem::path& folder);

/// A header stamp in a bag is the time of measurement. A record stamp is the time at which the bag recorded the
/// message. With record stamps, a sweep starts one sweep period before its stamp, because a bag records a sweep at the
/// end of the sweep.
enum class StampSource { header, record };

/// ReferenceOf selects the moving frame whose poses the reference topic contains: the body, the lidar, or the frame
/// that the messages name (`named`).
enum class ReferenceOf { named, body, lidar };

struct BagReading {
  std::vector<std::string> imu_topics;    ///< primary IMU first; empty: all Imu topics
  std::vector<std::string> lidar_topics;  ///< empty: all PointCloud2 or CustomMsg
  std::string reference_topic;            ///< Odometry, PoseStamped or TransformStamped
  ReferenceOf reference_of = ReferenceOf::named;
  sim::ImuRecord imu;                   ///< values that messages lack
  bool imu_placed = false;              ///< the user sets T_BI of `imu`
  bool lidar_placed = false;            ///< the user sets T_BL of `sweeps.device`
  std::optional<AccelUnit> accel_unit;  ///< empty: m/s^2, or g by the readings
  GyroUnit gyro_unit = GyroUnit::rad_s;
  StampSource stamps = StampSource::header;
  bool stamps_stated = false;  ///< the user chooses `stamps`
  SweepReading sweeps;
  std::string base_frame;  ///< frame of /tf_static for Imported::T_base_imu; empty: none
  /// If true, sensors have the names of their topics. An unreadable topic is then skipped with a note, if another topic
  /// of the same kind is readable.
  bool for_odometry = false;
};

/// A ROS 1 bag is a file, or a folder of its parts, which are merged by time; encrypted bags are not supported. A ROS 2
/// bag is a folder or a file, in SQLite or MCAP format, plain or Zstandard-compressed per file or message. An MCAP file
/// contains messages of ROS 2 (cdr) or ROS 1, in plain, LZ4 or Zstandard chunks, with or without index.
///
/// The importer checks the units of the IMU against gravity, and converts specific forces from g to m/s^2, with a note.
/// A duplicate message (equal stamp and content) is read once. Single faulty messages are skipped with a note
/// (left_out.hpp).
///
/// If the caller chooses no topics, point clouds in the frames "world", "map" or "odom" are skipped, because they are
/// not raw sensor data. If the caller chooses no topics, lidars whose points have times come first.
///
/// Sensor poses that the caller does not set come from /tf_static, relative to "body", "base_link" or another sensor.
/// If `sweeps.scratch` is set, memory contains only one sweep and the IMU data; otherwise, memory contains all points.
///
/// Throws BadInput with file and location for damaged or truncated data, a missing topic, or a wrong type. Also throws
/// BadInput for more than 5 % of faulty messages, or a cycle of frames.
Imported import_ros1_bag(const std::filesystem::path& path, const BagReading& reading);
Imported import_ros2_bag(const std::filesystem::path& path, const BagReading& reading);
Imported import_mcap(const std::filesystem::path& file, const BagReading& reading);

}  // namespace tumble::scenarios
