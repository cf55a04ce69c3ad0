// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"
#include "tumble/odometry/sensor_sheets.hpp"

namespace tumble {

struct ImuMergeState;
struct MergedImuRecording;
struct RollingOdometryExpertParams;
extern template class HeapValue<RollingOdometryExpertParams>;

/// Estimates the pose of a rolling sphere from one to four IMUs, through grip, slip, bumps and slopes. The reported
/// poses are live, smoothed with the data of the following `lag_s`, or smoothed with the whole recording.
/// RollingOdometry detects saturated readings that the IMU does not flag, fuses the IMUs to one IMU (ImuMerge), and
/// estimates the motion with RollingFilter and RollingSmoother.
///
/// The z axis of the world frame points upwards. The first sample defines origin and yaw of the world frame; the origin
/// is the sphere's centre. The sphere should be at rest for one second at the start.
///
/// The state of RollingOdometry takes half a megabyte, plus 0.1 MB per IMU and 11 KiB per 0.02 s of lag. If `lag_s` is
/// above 0, RollingOdometry computes poses in blocks of RollingSmoother::Params::kBlock_s. After start-up, add_imus()
/// allocates memory only at the end of a block, and for poses that take() has not yet returned. Each call of a member
/// function needs at most 256 KiB of stack. RollingOdometry starts no threads, uses no files and prints nothing. A copy
/// of a RollingOdometry contains the complete state. The limitations of ImuMerge, RollingFilter and RollingSmoother
/// apply to RollingOdometry.
class RollingOdometry {
 public:
  static constexpr double kWholeRecording = 1e9;  ///< value of Params::lag_s

  struct ImuSetup {
    ImuDataSheet data_sheet;
    /// pose of the IMU in axes B of the sphere, relative to the stated centre of the sphere: x_B = T_BI x_I
    Eigen::Isometry3d T_BI = Eigen::Isometry3d::Identity();
  };
  struct Params {
    double radius_m = 0.0;       ///< required; has no default
    std::vector<ImuSetup> imus;  ///< 1 to 4 IMUs; required
    /// Prior standard deviation of the sphere's true centre relative to the stated centre (the origin of T_BI).
    /// RollingOdometry estimates the true centre.
    double centre_sigma_m = 6e-3;
    double gravity_m_s2 = 9.80665;
    /// Lag of the poses that take() returns; 0: live poses. With kWholeRecording, add_imus() only stores the readings,
    /// newest() returns an empty value, and finish() estimates all poses.
    double lag_s = 0.0;

    using Expert = RollingOdometryExpertParams;
    HeapValue<Expert> expert;  ///< rarely changed parameters: odometry/expert_params.hpp

    /// Returns the names of parameters that RollingOdometry computes from other parameters and from data sheets.
    /// RollingOdometry ignores values that a user sets for computed parameters.
    static std::span<const char* const> computed_parameter_names();

    /// Increases the prior standard deviations for uncalibrated IMUs without data sheet, at unknown positions in the
    /// sphere. With the increased standard deviations, a sloped floor is very improbable a priori, because the
    /// accelerometer bias of an uncalibrated IMU resembles a slope.
    void widen_priors_for_unknown_imus();

    /// Callers of fields() must include odometry/expert_params.hpp.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.radius_m, {"radius_m", "m", 1e-3, 100.0, "radius of the sphere", ParameterAudience::common_use});
      visit(
          p.centre_sigma_m,
          {"centre_sigma_m", "m", 0.0, 10.0,
           "standard deviation of the position of the stated centre, which is the reference point of the IMU positions",
           ParameterAudience::common_use});
      visit(p.gravity_m_s2,
            {"gravity_m_s2", "m/s^2", 0.1, 100.0, "strength of gravity", ParameterAudience::common_use});
      visit(p.lag_s, {"lag_s", "s", 0.0, kWholeRecording,
                      "delay after which a smoothed pose is reported; a longer delay makes poses more accurate; 0: "
                      "live; 1e9: the whole recording",
                      ParameterAudience::common_use});
      visit.group("", *p.expert);
    }
  };
  struct SphereCalibration {
    Eigen::Vector3d sphere_centre_B_m =
        Eigen::Vector3d::Zero();  ///< true centre of the sphere, relative to the stated centre
    /// Estimated radius of the sphere, and its standard deviation. The standard deviation is 0 without smoothing
    /// (`lag_s` = 0), and if the radius is not estimated (expert.rolling.filter.radius_sigma_m is 0).
    double radius_m = 0.0, radius_sigma_m = 0.0;
  };
  struct Pose {
    PoseState pose;  ///< pose of the sphere's centre; live poses have no attitude covariance
    /// angular velocity of the sphere, in sphere axes
    Eigen::Vector3d angular_velocity_B_rad_s = Eigen::Vector3d::Zero();
    /// Covariance of the velocity of the sphere's centre, in sphere axes. If `lag_s` is above 0, the covariance of the
    /// velocity neglects that the contact mode is uncertain.
    Eigen::Matrix3d velocity_covariance_B_m2_s2 = Eigen::Matrix3d::Zero();
    ContactMode contact_mode = ContactMode::grip;
    bool at_rest = false;
    /// True after a restart, and during a slip, bump or flight that increases the standard deviation of the position by
    /// more than ContactModeParams::kEventSigmaGrowth_m.
    bool position_uncertain = false;
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit RollingOdometry(const Params& params);
  RollingOdometry(const RollingOdometry& other);
  RollingOdometry& operator=(const RollingOdometry& other);
  RollingOdometry(RollingOdometry&&) noexcept;
  RollingOdometry& operator=(RollingOdometry&&) noexcept;
  ~RollingOdometry();

  /// Processes simultaneous readings of all IMUs. All readings get the time stamp of the first IMU's reading.
  /// SampleClock corrects time stamps with jitter. Pass NaN for an IMU without a reading. OutlierFilter rejects
  /// outliers among the readings of each IMU. While OutlierFilter checks a sudden change of a reading, up to five
  /// samples of all IMUs wait, and newest() returns the pose before these samples. If add_imus() returns an error, the
  /// state is unchanged. The errors are `insufficient_data` (wrong number of IMUs, or no reading), `time_order`,
  /// `degenerate` (the first specific force is almost zero), `gap` and `out_of_range`. `out_of_range` means that the
  /// run has finished, the time stamp exceeds kStampMax_ns, or the only IMU with readings has a frozen axis.
  ///
  /// A single wrong time stamp causes the loss of only one sample. After a gap of more than a second, add_imus()
  /// rejects the first sample, returns `gap`, and restarts with the next sample. If the clock steps back, add_imus()
  /// rejects samples for 0.2 s, returns `time_order`, and then restarts. A restart completes the poses of the run
  /// before the restart, and starts a new run at the newest pose, like reset(pose). Poses after a restart have the flag
  /// `position_uncertain`, and their covariance includes the unknown motion during the gap.
  Status add_imus(std::span<const ImuSample> samples);
  /// Processes a sample of a sphere with one IMU. Returns `ok` or an error of add_imus().
  Status add_imu(const ImuSample& sample) { return add_imus({&sample, 1}); }

  /// Processes a sample of the IMU with the index `imu_index`, if the samples of the IMUs are not simultaneous.
  /// RollingOdometry resamples the readings of all IMUs to common times, which delays the poses by at most 0.05 s.
  /// RollingOdometry treats an IMU without readings as absent. Returns `ok`, an error of add_imus(), or `out_of_range`
  /// for an invalid IMU number. If the clock of an IMU steps back, add_imu() restarts as add_imus() does, and drops the
  /// readings of all IMUs that wait for readings of other IMUs.
  Status add_imu(std::size_t imu_index, const ImuSample& sample);

  /// Returns the pose at the newest sample, estimated from all data so far, or an empty value before the first sample.
  std::optional<Pose> newest() const;

  /// Returns the oldest pose that take() has not yet returned, or an empty value if there is no such pose. If `lag_s`
  /// is 0, the poses are live; otherwise the poses are smoothed and `lag_s` old.
  std::optional<Pose> take();

  /// Ends the run and smooths the remaining poses. After finish(), add_imus() rejects samples until reset(). Returns
  /// `ok`, or the first error of the samples that waited for samples of other IMUs. With kWholeRecording, finish()
  /// returns `ok`, an error of merge_recordings(), or an error of RollingSmoother::step().
  Status finish();

  /// Starts a new run at the origin and at rest. After reset(), take() still returns the remaining poses of the old
  /// run, and counters keep their values.
  void reset();
  /// Starts a new run at a known pose of the sphere, like reset(). Frame G has its origin at the sphere's centre.
  /// `T_WG` sets position and heading, and gravity at rest determines the tilt. Reported covariances describe errors
  /// relative to `T_WG`.
  void reset(const Eigen::Isometry3d& T_WG);

  /// Reports the current suspected faults of the IMUs. RollingOdometry ignores the readings of an IMU with a frozen
  /// axis. If all IMUs with readings have a frozen axis, add_imus() rejects the sample. With kWholeRecording, finish()
  /// checks the whole recording, and health() reports no finding before finish().
  SensorHealth health() const;

  /// Returns the merged readings and the health findings of a whole recording (detail/imu_findings.hpp). Returns null
  /// before finish(), or if `lag_s` is not kWholeRecording.
  const MergedImuRecording* whole_recording_result() const;

  /// Returns the estimated centre and radius of the sphere; if `lag_s` is above 0, at the time of the newest smoothed
  /// pose.
  SphereCalibration sphere_calibration() const;

  /// Returns true if the sphere was already moving at the first samples.
  bool started_in_motion() const;

  /// Returns the state of the fusion of several IMUs (attitude/detail/imu_merge.hpp). The state lists the IMUs that
  /// repeat one reading (frozen), contradict the other IMUs, or have a time offset.
  const ImuMergeState& imu_merge_state() const;

  /// Returns the number of readings of all IMUs that OutlierFilter rejected.
  std::size_t rejected_readings() const;
  /// Returns the number of restarts after a gap or after a clock that stepped back.
  std::size_t restart_count() const;
  /// Returns the jitter of the time stamps [s] while SampleClock corrects the time stamps, and otherwise an empty
  /// value.
  std::optional<double> estimated_jitter_s() const;

  /// Saves calibration, saturation limits of each IMU, and newest pose as bytes with a checksum, for load() after a
  /// reboot. The calibration contains biases, scales and delay of the merged IMU, and centre and radius of the sphere,
  /// with covariance. Every machine saves numbers in little-endian order. The saved bytes contain no velocity, contact
  /// mode, differences between the IMUs, health findings or counters. The saved bytes also omit recorded readings, and
  /// poses that take() has not yet returned.
  std::vector<std::byte> save() const;
  /// Starts a new run from the bytes that save() returned, and discards the previous state of the object. The saved
  /// calibration and saturation limits replace the initial values in the parameters, also after a later reset(). The
  /// saved biases get the initial uncertainty, because biases change at every switch-on. The new run starts at the
  /// saved pose, with the saved covariance of this pose. All poses of the new run have the flag `position_uncertain`.
  /// If the sphere may have moved since save(), call reset(pose) after load().
  ///
  /// `last_pose` receives the saved pose with its time in the clock of the saved run. If no pose was saved, `last_pose`
  /// is empty. If load() returns an error, the object is unchanged, and the returned status names the field, the saved
  /// value and the bound. The error is `insufficient_data` (truncated bytes), `non_finite` or `out_of_range`. The
  /// function load() rejects damaged bytes, and bytes that another version or a TumblingOdometry saved. A saved run
  /// with another radius or other IMUs is also rejected.
  Status load(std::span<const std::byte> bytes, std::optional<PoseState>* last_pose = nullptr);

  struct Impl;  ///< private implementation

 private:
  HeapValue<Impl> impl_;
};

}  // namespace tumble
