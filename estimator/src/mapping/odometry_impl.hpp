// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <deque>
#include <limits>

#include "inertial_prior.hpp"
#include "tumble/mapping/calibration.hpp"
#include "tumble/mapping/deskew.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/mapping/lone_returns.hpp"
#include "tumble/mapping/map_drawing.hpp"
#include "tumble/mapping/registration.hpp"
#include "tumble/mapping/sweep_trajectory.hpp"
#include "tumble/mapping/voxel_map.hpp"

namespace tumble {

namespace mapping {

/// What the sweeps so far say of the next one's unknowns.
struct Prediction {
  Registration::Prior prior;
  Registration::Matrix by_last = Registration::Matrix::Identity();  ///< of its means by the unknowns at the last's end
  Registration::Matrix noise = Registration::Matrix::Zero();        ///< that arises in between
  Registration::Matrix errors = Registration::Matrix::Zero();       ///< covariance of the means' errors, as reported

  /// From the weight and the errors of the unknowns at the last sweep's end.
  void compose(const Registration::Matrix& covariance, const Registration::Matrix& error_covariance);
  /// Known to be at rest: velocity zero, and no longer correlated with the rest. Before compose().
  void hold_still(double sigma_m_s);
  /// Known velocity in IMU axes, which turns with the attitude. Before compose().
  void follow(const Eigen::Vector3d& v_WI_I_m_s, double sigma_m_s);
};

/// A sweep that those after it still refine. Unknowns are those of its start.
struct WindowSweep {
  Registration::Estimate filtered, smoothed;
  Registration::Matrix filtered_errors, smoothed_errors;  ///< covariances
  Registration::Estimate predicted;
  Registration::Matrix predicted_errors;
  Registration::Matrix by_before;  ///< of the predicted by the unknowns of the sweep before
  std::vector<MotionSample> samples;
  TimeNs end_ns = 0;
  struct Drawn {
    std::uint32_t index;  ///< in the map
    SweepPoint point;     ///< by the filtered calibration
  };
  std::vector<Drawn> drawn;
};

/// First-order effect on the unknowns, their motion taken `t_s` after the start, of the unknowns at the start.
Registration::Matrix unknowns_at(const SweepTrajectory& trajectory, double t_s);

/// Of the saturation deficit from knot to knot.
double knot_correlation(const LidarInertialOdometry::Params& params, const SweepTrajectory& trajectory);

void check_params(const LidarInertialOdometry::Params& params);
Registration::Params registration_params(const LidarInertialOdometry::Params& params);
/// Of a return, as the registration has it.
RangeNoise range_noise(const LidarInertialOdometry::Params& params);
/// For all points of a sweep: what has not settled by then is cheaper settled with some of them.
Registration::Params brief_registration_params(const LidarInertialOdometry::Params& params);
/// Wider in every respect: finds the neighbourhood of the answer, not the answer.
Registration::Params coarse_registration_params(const LidarInertialOdometry::Params& params);

}  // namespace mapping

/// All that the odometry remembers; its parts lie in odometry_*.cpp.
struct LidarInertialOdometry::Impl {
  explicit Impl(const Params& p)
      : params((mapping::check_params(p), p)),
        map({p.map_voxel_m, p.map_spacing_m}),
        range_noise(mapping::range_noise(p)),
        registration(mapping::brief_registration_params(p)),
        patient(mapping::registration_params(p)),
        coarse(mapping::coarse_registration_params(p)) {}

  // odometry_imu.cpp
  void take(const ImuSample& sample, const RateState& rate);
  bool settle_force(const MotionSample& next);

  // lidar_inertial_odometry.cpp
  Status check_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points) const;
  void finish(TimeNs end_ns, bool aligned, SweepReport& report);

  // odometry_calibration.cpp
  void start_calibration();
  void count_errors();
  double innovation() const;
  void carry_covariance(TimeNs end_ns);
  std::vector<PoseState> describe(const SweepTrajectory& motion, const Registration::Matrix& at_start) const;
  Eigen::Matrix<double, 6, 6> reported_covariance(const Registration::Matrix& joint,
                                                  const Eigen::Vector3d& p_WI_m) const;
  void count_drift(const SweepReport& report);
  Eigen::Matrix<double, 6, 6> drawing_covariance() const;

  // odometry_registration.cpp
  mapping::Prediction predict() const;
  void carry_excess(mapping::Prediction& next) const;
  void add_excess_noise(mapping::Prediction& next) const;
  bool prior_is_trusted() const;
  void choose_points();
  void choose_few();
  Status align(const Registration::Prior& prior, TimeNs end_ns, Registration::Result& result);
  Status try_start(const Registration::Prior& start, const Registration::Prior& prior, TimeNs end_ns,
                   Registration::Result& result);
  Status align_to_convergence(const Registration::Prior& prior, TimeNs end_ns, Registration::Result& result);
  Status search(const Registration::Prior& prior, TimeNs end_ns, Registration::Result& result);
  /// Whether it was aligned, be it in no direction that holds it.
  bool register_sweep(TimeNs end_ns, SweepReport& report);
  Status fall_back_on_inertia(TimeNs end_ns);
  bool imu_rests(TimeNs end_ns) const;
  bool trajectory_speeds_up() const;

  // odometry_window.cpp
  void enter_window(TimeNs end_ns, bool aligned, SweepReport& report);
  void smooth();
  void redraw(mapping::WindowSweep& sweep);
  std::vector<PoseState> describe(const mapping::WindowSweep& sweep) const;

  // odometry_map.cpp
  std::size_t extend_map(bool rings_differ);
  void forget_far_map();

  Params params;
  bool started = false;
  Eigen::Matrix3d railed_before = Eigen::Matrix3d::Zero();  // variance of the velocity, of the last sweep's rails
  MotionState state;                                        // at the end of the last sweep, as the next three
  SweepCalibration calibration;
  Registration::Excess excess_rad_s = Registration::Excess::Zero();
  /// Of all three: what weighs them against the next sweep, and what they are thought to be off by. The first counts a
  /// point for less than it tells, so that it bears with outliers; the second follows the errors through what the first
  /// made of them.
  Registration::Matrix covariance = Registration::Matrix::Zero();
  Registration::Matrix error_covariance = Registration::Matrix::Zero();
  Eigen::Vector3d excess_share_at_end = Eigen::Vector3d::Zero();  // on the rail there; 0 where it was not aligned
  Registration::Matrix end_by_start = Registration::Matrix::Identity();  // of the last sweep's unknowns
  /// Pose errors of the IMU by errors of the mounting while the lidar's pose is certain: at the start.
  Eigen::Matrix<double, 6, 6> start_by_mounting = Eigen::Matrix<double, 6, 6>::Zero();
  /// Of the map against the world where the robot is: it was drawn from poses that were uncertain themselves.
  Eigen::Matrix<double, 6, 6> map_covariance = Eigen::Matrix<double, 6, 6>::Zero();
  /// Of the position, in directions that no surface held while the robot moved.
  Eigen::Matrix3d drift_covariance_m2 = Eigen::Matrix3d::Zero();
  int resting_sweeps = 0;  // in a row, by the IMU
  bool unmatched = false;  ///< the present sweep has points, but the map too few of them
  int lost_sweeps = 0;
  int failed_searches = 0;  // sweeps in a row that had points and found no place
  mapping::InitialRest rest;
  std::vector<MotionSample> samples;  // from the window that holds state.time_ns on
  struct {
    Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();
    TimeNs middle_ns = 0;
    bool known = false;
  } before_newest, newest;  // windows of the IMU
  std::deque<mapping::WindowSweep> window;
  std::vector<mapping::WindowSweep::Drawn> drawn;  // by the present sweep
  VoxelMap map;
  std::vector<Eigen::Vector3f> seen_from_W_m;  // per sweep that gave points to the map
  Eigen::Vector3f pruned_at_W_m = Eigen::Vector3f::Zero();
  mapping::ScanLines scan_lines;

  // memory kept between sweeps
  RangeNoise range_noise;
  Registration registration, patient, coarse;
  mapping::Prediction prediction;                              // of the present sweep
  Registration::Result result;                                 // of the present sweep
  Registration::Matrix errors = Registration::Matrix::Zero();  // of its unknowns: covariance
  SweepTrajectory trajectory;
  LoneReturns lone_returns;
  SweepSampler sampler;
  std::vector<SweepPoint> points, chosen, few, some;
  std::vector<Eigen::Vector3f> positions_W_m;
  std::vector<std::uint32_t> chosen_index;

  struct Odometer {
    Eigen::Vector3d v_WI_I_m_s = Eigen::Vector3d::Zero();
    double sigma_m_s = 0.0;
    bool known = false;
  } odometer;  // of the next sweep
};

}  // namespace tumble
