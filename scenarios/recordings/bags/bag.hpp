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
#include "scenarios/recordings/bags/bag_layout.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/stored_truth.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// BagCloud contains points in W that the bag stores in the topic "/TRACK/points" (sensor_msgs/PointCloud2: x y z, and
/// error_m if known).
struct BagCloud {
  std::vector<Eigen::Vector3f> position_W_m;
  std::vector<float> error_m;  ///< parallel, or empty
};

/// BagTrack is a series of body poses in W, which becomes the topic "/NAME" (nav_msgs/Odometry) and part of /tf in a
/// bag.
struct BagTrack {
  struct Pose {
    std::int64_t time_ns = 0;
    Eigen::Vector3d p_WB_m = Eigen::Vector3d::Zero();
    Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
    Eigen::Vector3d v_WB_B_m_s = kUnknown, w_WB_B_rad_s = kUnknown;
    /// The covariance refers to (position in W, attitude error phi in W), as in PoseState; a block of zeros is unknown.
    Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
    bool exact = false;  ///< a true pose: zeros are the covariance
    inline static const Eigen::Vector3d kUnknown = Eigen::Vector3d::Constant(kNaN);
  };
  std::string name;  ///< letters, digits and _
  std::vector<Pose> poses;
  std::vector<std::int64_t> cloud_time_ns = {};  ///< times of point clouds along the track
  /// Creates a cloud immediately before the bag stores it, so that only one cloud is in memory. Clouds without points
  /// are omitted.
  std::function<BagCloud(const BagTrack&, std::size_t)> cloud = {};
};

/// BagWriting contains the options for writing a recording to a bag.
struct BagWriting {
  std::int64_t origin_ns = 0;          ///< origin of the recording; see export_origin_ns
  const StoredTruth* truth = nullptr;  ///< written if not null
  std::vector<BagTrack> tracks = {};   ///< estimates; names are unique and differ from export_names' `taken`
  SweepLayout sweeps = own_sweep_layout();
  /// The vector `points` gives access to the points of each lidar on disk; null if the points are in memory.
  const std::vector<PointStore>* points = nullptr;
  std::optional<ReaderNames> names = {};  ///< if set: only the first IMU and the first lidar, with these names
  bool empty_sweeps = true;               ///< false: omits sweeps without points
};

/// Each export function writes a recording as a bag in one of the following three formats.
///
/// - The ROS 1 format is version 2.0, written by librosbag.
/// - The ROS 2 format is a folder with metadata.yaml (version 5) and a SQLite file of CDR messages with definitions
///   (schema 4, as since Iron).
/// - The MCAP format is a file with profile ros2 (mcap.dev/spec), with indexed LZ4 chunks of 1 MiB and all checksums.
///
/// Bags in all three formats contain the following topics.
///
/// - The topic "/NAME" is a sensor_msgs/Imu without attitude; its covariance is the white noise of the data sheet. The
///   text NAME is the exported name of the sensor (export_names). The topic of the primary IMU is the first topic of
///   its type.
/// - The topic "/NAME/points" is a sensor_msgs/PointCloud2, stamped at the sweep's start, with the fields of Velodyne
///   drivers: x y z intensity ring time. The field time is in float32 seconds after the stamp (4 ns resolution within
///   0.1 s). The field offset_ns is the same time in whole nanoseconds. For points without times, the fields time and
///   offset_ns are omitted. The option `sweeps` can select another point layout.
/// - The topic "/truth" is a nav_msgs/Odometry of "body" in "world", at most every 5 ms. The topics "/TRACK" and
///   "/TRACK/points" contain estimates. Unknown values have the variance -1, as in sensor_msgs/Imu, and an unknown
///   twist is zero.
/// - The topic "/tf_static" contains the pose of each sensor in "body", from the calibration that the estimator uses.
/// - The topic "/tf" contains the pose of "body" in "world" from the truth, or else from the first track. Each further
///   track has a frame "TRACK".
/// - The topic "/clock" is a rosgraph_msgs/Clock, published with the first message after every 10 ms.
///
/// Throws BadInput if the output cannot be written.
void export_ros1_bag(const sim::Sensors& sensors, const BagWriting& writing, const std::filesystem::path& file);
void export_ros2_bag(const sim::Sensors& sensors, const BagWriting& writing, const std::filesystem::path& folder);
void export_mcap(const sim::Sensors& sensors, const BagWriting& writing, const std::filesystem::path& file);
/// Writes a folder with an MCAP file and metadata.yaml, the layout of ROS 2 since Iron.
void export_ros2_mcap(const sim::Sensors& sensors, const BagWriting& writing, const std::filesystem::path& folder);

/// StampSource selects the stamp of a message: the header's stamp (time of measurement), or the record's stamp (time at
/// which the bag recorded the message). A sweep is recorded at its end. With record stamps, a sweep therefore starts
/// one period before its stamp.
enum class StampSource { header, record };

/// ReferenceOf is the frame to which the reference poses belong. The value `named` is the frame named in the messages,
/// if the bag contains its transform. The values `body` and `lidar` are the body and the first lidar.
enum class ReferenceOf { named, body, lidar };

/// BagReading contains options for reading a bag.
struct BagReading {
  std::vector<std::string> imu_topics;    ///< the first is the primary IMU; empty: all Imu topics in the bag's order
  std::vector<std::string> lidar_topics;  ///< empty: all of type PointCloud2 or CustomMsg
  std::string reference_topic;            ///< Odometry, PoseStamped or TransformStamped; "": none
  ReferenceOf reference_of = ReferenceOf::named;
  sim::ImuRecord imu;                   ///< values that messages lack: device, ranges, noise, T_BI
  bool imu_placed = false;              ///< the user states T_BI of `imu`, also if it is the identity
  bool lidar_placed = false;            ///< the user states T_BL of `sweeps.device`, also if it is the identity
  std::optional<AccelUnit> accel_unit;  ///< empty: m/s^2 as in sensor_msgs/Imu, or g if the readings indicate g
  GyroUnit gyro_unit = GyroUnit::rad_s;
  StampSource stamps = StampSource::header;
  SweepReading sweeps;
  /// If `leave_out_topics` is true, an unreadable topic is skipped with a note, provided that another topic of the same
  /// kind is readable. An unreadable topic that the caller chose is always an error.
  bool leave_out_topics = false;
};

/// Each import function reads a ROS 1 bag (a file or a folder of its parts, not encrypted), a ROS 2 bag, or an MCAP
/// file. A ROS 2 bag is a folder or a single file: SQLite or MCAP, plain or Zstandard-compressed per file or message.
/// An MCAP file may contain messages of ROS 2 (cdr) or ROS 1, in plain, LZ4 or Zstandard chunks, with or without index.
///
/// The option `stamps` selects the message times. The notes of the result describe how the stamps of headers and
/// records differ. The reader checks the units of the IMU against gravity, as for CSV files. Specific force in g at
/// rest, as from Livox drivers, is converted, with a note. Each sensor is named after its topic. The points of a bag
/// are converted by the rules of import_sweeps. A duplicate message (equal stamp and content) is read once. Single
/// faulty messages are skipped with a note (left_out.hpp).
///
/// Unless the caller chooses topics, the reader skips clouds in the frames "world", "map" or "odom", because these
/// clouds are not raw sensor data. If the caller chooses no topics, lidars whose points have times come first.
///
/// The reader merges the parts of a ROS 1 bag in a folder by time. The files of a ROS 2 bag are read in order of time.
/// Files that metadata.yaml does not list, but that have similar names, are also read.
///
/// The pose of a sensor in "body" or "base_link", or relative to another sensor, comes from /tf_static unless the
/// caller sets the pose. With `sweeps.scratch`, memory contains only one sweep, the IMU data (81 bytes per sample) and
/// some bytes per message. Without `sweeps.scratch`, the reader keeps all points in memory. Throws BadInput with file
/// and location for damaged or truncated data, a missing topic or wrong type, more than 5 % of faulty messages, or a
/// cycle of frames.
Imported import_ros1_bag(const std::filesystem::path& path, const BagReading& reading);
Imported import_ros2_bag(const std::filesystem::path& path, const BagReading& reading);
Imported import_mcap(const std::filesystem::path& file, const BagReading& reading);

}  // namespace tumble::scenarios
