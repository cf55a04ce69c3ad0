// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "imu_time_alignment.hpp"
#include "odometry_pass.hpp"
#include "position_alignment.hpp"
#include "second_pass.hpp"
#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/attitude/detail/imu_plausibility.hpp"
#include "tumble/attitude/detail/regime_smoother.hpp"
#include "tumble/common/detail/outlier_filter.hpp"
#include "tumble/common/sample_clock.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/odometry/detail/mapping_passes.hpp"
#include "tumble/odometry/detail/waiting_input.hpp"
#include "tumble/odometry/expert_params.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"

namespace tumble {

/// Functions of Impl that have the name of a public function are documented in the public header.
struct TumblingOdometry::Impl {
  explicit Impl(const Params& params);

  Status add_imu(const ImuSample& sample);
  Status add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points);
  Status add_sweep(std::size_t lidar, TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points);
  Status add_reading(const OdometerReading& reading);
  void reset();
  void reset(const Eigen::Isometry3d& T_WI);
  Status newest(PoseState& pose, Eigen::Matrix3d* velocity_covariance_I_m2_s2 = nullptr) const;
  SensorHealth health() const;
  std::optional<AngularRateState> newest_rate() const {
    return odometry_pass_.rates().rate().newest(odometry_pass_.rate_stream_state().rate);
  }
  BodyImuCalibration body_imu_calibration() const;
  const SaturationLevels& saturation_levels() const;
  const LidarInertialOdometry& mapper() const;
  std::vector<std::byte> save() const;
  Status load(std::span<const std::byte> bytes, std::optional<PoseState>* last_pose);

  Status process_ordered_sample(const ImuSample& sample);
  void register_sweep(TimeNs start_ns, TimeNs end_ns, std::vector<LidarPoint> points);
  bool is_due(TimeNs end_ns) const;
  std::size_t max_waiting_sweeps() const;
  void register_sweeps_with_rates();
  void flush_all();
  void restart_rate_estimation();
  void restart_at_newest();
  void restart_without_first_sample();
  void restart_with_gyro_offset(const Eigen::Vector3d& offset_rad_s);
  void set_gyro_offset(const Eigen::Vector3d& offset_rad_s);
  const Eigen::Vector3d& gyro_offset_rad_s() const {
    return odometry_pass_.rates().params().rate.model.nominal.gyro_bias_rad_s;
  }
  void start_rate_estimation();
  bool uses_whole_recording() const { return params_.lag_s >= kWholeRecording; }
  Status record_sample(const ImuSample& sample);
  Status finish_whole_recording(const SweepProgress& on_sweep);

  Params params_;                                ///< with the calibration of load()
  LidarImuCalibrationPrior stated_calibration_;  ///< calibration that the caller stated
  StampOrder stamp_order_;
  StampOrder::State stamp_order_state_;
  GyroOffset gyro_offset_;
  GyroOffset::State gyro_offset_state_;
  OutlierFilter outlier_filter_;
  OutlierFilter::State outlier_filter_state_;
  SampleClock sample_clock_;
  SampleClock::State sample_clock_state_;  ///< state of the clock from accepted samples
  ImuPlausibility plausibility_;
  ImuPlausibility::State plausibility_state_;
  OdometryPass odometry_pass_;
  FirstSecondsReprocessing first_seconds_reprocessing_;
  std::optional<TimeNs> newest_ns_;  ///< time of the newest accepted sample
  std::optional<TimeNs>
      last_registered_ns_;  ///< end of the last registered sweep; before the first, time of the first sample
  std::size_t restart_count_ = 0, dropped_sweeps_ = 0, sweeps_before_first_imu_ = 0;
  std::deque<WaitingSweep> waiting_sweeps_;
  FurtherLidars further_lidars_;
  WaitingReadings readings_;
  PositionAlignment positions_;
  std::deque<Sweep> finished_results_;
  std::optional<TimeNs> sweep_end_ns_;       ///< end of the last accepted sweep
  std::vector<ImuSample> recorded_samples_;  ///< samples of a whole recording; the sweeps are in `waiting_sweeps_`
  std::shared_ptr<const WholeRecordingEstimate> whole_recording_result_;  ///< set by finish() with kWholeRecording
  bool finished_ = false;
};

}  // namespace tumble

namespace tumble::odometry {

/// Throws InvalidParams if a parameter of TumblingOdometry is out of bounds.
MotionRegimeStream::Params rate_stream_params(const TumblingOdometry::Params& params);

/// When estimating a whole recording, the prior standard deviations of accelerometer bias and inertia are larger than
/// in live operation (see AngularRateStreamParams::model).
MotionRegimeSmoother::Params recording_rate_params(const TumblingOdometry::Params& params);

OutlierFilter::ImuRanges outlier_params(const TumblingOdometry::Params& params);
LidarInertialOdometry::Params mapper_params(const TumblingOdometry::Params& params);

}  // namespace tumble::odometry
