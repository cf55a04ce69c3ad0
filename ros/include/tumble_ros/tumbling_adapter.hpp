// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/tumble.hpp"
#include "tumble_ros/node_params.hpp"
#include "tumble_ros/point_cloud.hpp"
#include "tumble_ros/publisher.hpp"
#include "tumble_ros/schedule.hpp"

namespace tumble::ros {

/// StartPose is the pose of the base at the start of a run. The standard deviations limit the search in a prior map.
struct StartPose {
  Eigen::Isometry3d T_OB = Eigen::Isometry3d::Identity();
  double sigma_m = 0.0;    ///< standard deviation of the position per axis; 0: exact
  double sigma_rad = 0.0;  ///< standard deviation of the heading; 0: exact
};

/// TumblingAdapter connects TumblingOdometry to the messages of a robot. TumblingAdapter contains the logic of the ROS
/// nodes and needs no ROS. The adapter publishes the library's estimates unchanged.
///
/// | call | when |
/// | --- | --- |
/// | Publisher::imu | for each IMU sample, lag_s later |
/// | Publisher::odometry, points | for each registered sweep |
/// | Publisher::position_pose | for each registered sweep, once positions determine their frame |
/// | Publisher::odometry_imu | for each accepted IMU sample after the first registered sweep |
/// | Publisher::map, diagnostics | at the periods of the parameters |
///
/// The odometry frame has its z axis up. If the base is level at the start, the odometry frame has the origin and
/// heading of the base frame at the start. If the base is tilted at the start, the error of the origin is the tilt
/// times the distance from base to IMU. Results are published within on_imu(). If the clock steps back, the library
/// restarts after 0.2 s at the newest pose.
class TumblingAdapter {
 public:
  using Params = TumblingAdapterParams;

  /// Throws InvalidParams like TumblingOdometry. `publisher` must outlive the adapter.
  TumblingAdapter(const Params& params, Publisher& publisher);

  /// Processes an IMU sample in IMU axes. Returns the status of TumblingOdometry::add_imu().
  Status on_imu(const ImuSample& sample);
  /// Processes a point cloud in lidar axes. Returns the status of PointCloudReader::read() or of
  /// TumblingOdometry::add_sweep(). A busy computer may deliver clouds seconds before the simultaneous IMU samples. The
  /// adapter keeps at most 32 early clouds until the IMU samples arrive.
  Status on_cloud(const PointCloudView& cloud);
  /// Processes a CustomMsg of a Livox driver, in CDR. Returns the status of LivoxCloud::parse() or of on_cloud().
  Status on_livox(std::span<const std::uint8_t> cdr);
  /// Processes the position of the antenna, with its covariance, in a frame with z up. Returns the status of
  /// TumblingOdometry::add_frame_alignment_position().
  Status on_position(TimeNs stamp_ns, const Eigen::Vector3d& position_m, const Eigen::Matrix3d& covariance_m2);
  /// Registers and publishes the sweeps that wait for later samples, at the end of a recording.
  void finish();
  /// Starts a new run. `start` gives position and heading of the base. Without `start`, the run starts at the origin,
  /// or anywhere in the prior map. Returns `ok`, or an error of TumblingOdometry::set_prior_map().
  Status reset(const std::optional<StartPose>& start = std::nullopt);
  /// Starts a new run that localises the robot in a map. `bytes` are the contents of a map file: map_file.hpp. Returns
  /// `ok`, or an error of read_map() or reset(). After an error of read_map(), the run continues.
  Status load_map(std::span<const std::byte> bytes);

  /// Returns the estimated mounting and lever arm as a ROS 2 parameter file, from which the next run can start.
  std::string calibration_yaml() const;
  std::vector<MapPoint> map() const { return odometry_.mapper().map(); }
  /// Returns the map as contents of a file: PLY for the extension .ply, otherwise the format of load_map().
  std::string map_file(const std::string& path) const;
  const TumblingOdometry& odometry() const { return odometry_; }

 private:
  bool is_early(const TimedSweep& sweep) const;
  Status add_sweeps();
  Status add_sweep(TimedSweep sweep);
  void publish_rate();
  void publish_sweeps();
  void publish_points(const SweepResult& report);
  void publish_newest();
  void publish_diagnostics();
  const AngularRateState& rate_at(TimeNs time_ns) const;

  Params params_;
  Publisher& publisher_;
  TumblingOdometry odometry_;
  std::vector<MapPoint> prior_map_;
  PointCloudReader reader_;
  std::deque<ImuSample> samples_;       ///< accepted samples whose rate is not smoothed yet
  std::deque<AngularRateState> rates_;  ///< smoothed rates of the last seconds
  std::deque<TimedSweep> early_;        ///< sweeps that wait for IMU samples
  std::deque<TimedSweep> sweeps_;       ///< sweeps that wait for their poses
  std::optional<SweepResult> last_;     ///< newest registered sweep, without its trajectory
  Rejections imu_, clouds_, positions_;
  Schedule map_, diagnostics_;
};

}  // namespace tumble::ros
