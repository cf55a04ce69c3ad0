// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/pose.hpp"
#include "tumble/common/status.hpp"
#include "tumble/mapping/calibration.hpp"
#include "tumble/mapping/executor.hpp"
#include "tumble/mapping/flight_arc.hpp"
#include "tumble/mapping/lidar.hpp"
#include "tumble/mapping/odometry_parts.hpp"

namespace tumble {

class StateWriter;
class StateReader;
class StateLayout;

/// What became of a sweep. Anything but `registered` means that the pose rests on the inertial prior.
enum class SweepVerdict : std::uint8_t {
  first,       ///< started the map
  registered,  ///< aligned with the map in all six directions
  degenerate,  ///< aligned where the surfaces allow it, prior elsewhere (everywhere, when conditioning is 0)
  rejected,    ///< too few matches, or a correction beyond the bound: prior kept; the map grows where it had too few
};
const char* to_string(SweepVerdict verdict);

/// Lidar-inertial odometry and mapping of a body that tumbles: integrates the IMU between sweeps, deskews each point at
/// its own time, registers the sweep to a voxel map by k-nearest-neighbour point-to-plane, and extends the map.
/// Position, attitude and velocity at the start of a sweep are refined together, so that the deskewing is refined too.
///
/// World: z up, origin and yaw at the IMU at the first sample, levelled by the specific force at rest.
/// Feed IMU samples in time order, then each sweep once IMU samples reach its end. No threads of its own, no files, no
/// printing. Where their standard deviation is not 0, the lidar's mounting, its clock and gravity are estimated with
/// the motion, as one state with one covariance: an iterated error-state filter over sweeps, whose last window_sweeps
/// are smoothed by those that follow (fixed lag), with what they drew into the map. Beyond the window the map stays
/// where it was drawn: a caller that keeps its recording runs a second time from calibration() and gets a map of one
/// piece.
///
/// Covariances reported follow the errors through the filter's weights, the registration's share as measured from its
/// residuals (Registration::Result::score_covariance).
///
/// After rejected sweeps the sensor is lost: the inertial prior goes on, with velocity zero while the IMU rests, and
/// each further sweep is also tried against the map from starts around the prior, coarse to fine. Not modelled: biases
/// of the IMU but the gyro's at the start, loop closure, moving objects.
class LidarInertialOdometry {
 public:
  struct Params {
    Eigen::Isometry3d T_IL = Eigen::Isometry3d::Identity();  ///< lidar in IMU axes
    double time_offset_s = 0.0;                              ///< the IMU's clock minus the lidar's
    /// Standard deviations of T_IL, of the time offset and of gravity's horizontal part; 0: exact, not estimated.

    double mount_sigma_rad = 0.0;
    double mount_sigma_m = 0.0;
    double time_offset_sigma_s = 0.0;
    double gravity_sigma_m_s2 = 0.0;
    double gravity_m_s2 = 9.80665;
    double rest_s = 0.5;  ///< at most this much of the start is used to level the attitude
    /// At rest (`mapper_rest.hpp`) the rate stays within rest_rate_rad_s of the bias and of its mean, and the specific
    /// force within rest_force_m_s2 of gravity and of its mean. During the rest at the start the robot is held still,
    /// and the mean rate becomes the gyro's bias.
    double rest_rate_rad_s = 0.05;
    double rest_force_m_s2 = 0.5;
    double range_min_m = 0.3;        ///< nearer returns are dropped
    double range_max_m = 100.0;      ///< farther returns are dropped
    Eigen::AlignedBox3d own_body_L;  ///< returns inside are the robot's own; an empty box, as here, keeps all
    double sweep_voxel_m = 0.25;     ///< one point per voxel of a sweep is registered
    double map_voxel_m = 0.5;        ///< cell of the map's hash
    double map_spacing_m = 0.1;      ///< at most one map point per cube of this edge
    int neighbours = 12;             ///< k of the plane fit
    double match_distance_m = 1.0;   ///< farther map points are no match
    /// Of a registration; one with all points has at most eight, what has not settled goes on with a thousand of them;
    /// [1, 200].
    int iterations_max = 30;
    double correction_max_m = 15.0;   ///< a larger correction of the prior is rejected
    double correction_max_rad = 1.1;  ///< a larger correction of the prior is rejected
    /// What the inertial side may be wrong by after 0.1 s, beside what RateState reports: standard deviations that grow
    /// in proportion to time. Loose in doubt; tight holds a world with few features.
    double prior_sigma_m = 0.003;
    double prior_sigma_rad = 0.002;
    double prior_sigma_m_s = 0.01;
    /// Standard deviation of the angle turned as a share of it: scale, misalignment, and a rate that changes within a
    /// sample.
    double turn_sigma_share = 0.001;
    /// Standard deviation of the specific force as a share of its magnitude: velocity is uncertain by this times the
    /// integral of the force, which counts at impacts.
    double force_sigma_share = 0.03;
    /// Readings of the accelerometer from accel_rail_m_s2 on, or flagged by the device, are at its rail: there the
    /// force may be larger by railed_force_m_s2 (standard deviation), for as long as the rail lasts.
    double accel_rail_m_s2 = 1e5;
    double railed_force_m_s2 = 50.0;
    /// Standard deviation assumed for a rate on a clipped axis that the rate method did not recover.
    double clipped_sigma_rad_s = 3.0;
    double gap_force_m_s2 = 5.0;        ///< what the force of a gap may be off by: the velocity goes on through it
    double rate_sigma_max_rad_s = 5.0;  ///< what RateState reports is believed up to this
    /// Estimate the excess of the rate on clipped axes in the registration, at SweepTrajectory::kKnots knots a sweep;
    /// it acts on clipped samples only, there in proportion to the rate's reported uncertainty. Its prior is the rate's
    /// reported uncertainty, at least excess_sigma_min_rad_s, correlated over excess_time_s; on a rail that lasts over
    /// the border of two sweeps it goes on from where it was.
    bool estimate_saturation_deficit = false;
    double excess_sigma_min_rad_s = 1.0;
    double excess_time_s = 0.3;
    double excess_carry_max = 3.0;    ///< over a border it grows by no more where less is known after it
    double excess_knot_share = 0.05;  ///< of its standard deviation, by which a knot may differ from its neighbours
    /// Sweeps that are refined together: the newest, and so many less one before it by what it teaches (see settled).
    /// 1: none is refined later.
    int window_sweeps = 2;
    /// Given the body, its flight is told by the ballistic arc: where the specific force at the centre of mass is below
    /// flight_force_m_s2, the accelerometer's reading gives way to what flight makes it, and a gap of
    /// the IMU that begins in flight is bridged by the arc. Empty: the accelerometer throughout.
    std::optional<FlyingBody> body;
    double flight_force_m_s2 = 4.0;
    /// A point's uncertainty grows over the sweep by this and weighs it down (the published time weighting).
    double skew_sigma_m_s = 0.25;
    /// A sweep that its surfaces alone hold less surely than this in some direction is `degenerate` (standard
    /// deviation, attitude counted at the rms lever).
    double degenerate_sigma_m = 0.15;
    std::size_t matches_min = 100;  ///< fewer matched points reject a sweep
    /// A sweep with too few matches still extends the map, as `degenerate`, while the inertial prior is this certain
    /// (standard deviations): at rest a lidar draws rings only, which give no planes until it turns. Points that the
    /// attitude leaves too uncertain at their range stay out by map_sigma_max_m.
    double trusted_prior_m = 0.1;
    double trusted_prior_rad = 0.1;
    /// The map is kept within this of the sensor, to a tenth of it.
    double map_radius_m = 100.0;
    /// Points that the trajectory places less surely than this are kept out of the map.
    double map_sigma_max_m = 0.25;
    /// Sweeps in a row with points but no place in the map, after which it goes on `degenerate` by inertia.
    int lost_sweeps_max = 30;
    OdometryStartParams start;
    StandstillParams standstill;
    RegistrationEffortParams effort;
    RelocalizationParams search;
    WorldCovarianceParams world;
    /// Threads, if any, that the registration may use; results do not depend on it.
    ParallelFor parallel_for;

    /// Every number of it, stated once: `lidar_inertial_odometry_fields.hpp`.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit);
  };

  struct SweepReport {
    SweepVerdict verdict = SweepVerdict::rejected;
    PoseState pose;                     ///< pose and velocity of the IMU at the end of the sweep, with covariance
    std::vector<PoseState> trajectory;  ///< IMU poses inside the sweep at IMU times, corrected by the registration
    /// The same of the sweep that stands at the old end of the window with this one as its newest: its last word, by
    /// this sweep and those between. With a window of two that is the sweep before. Empty while the window fills.
    std::vector<PoseState> smoothed;
    double inlier_share = 0.0;  ///< of the points registered
    double conditioning = 0.0;  ///< smallest over largest eigenvalue of the scaled normal matrix
    /// Standard deviation in the direction that the surfaces hold least, by this sweep's surfaces alone; 0: not
    /// aligned.
    double weakest_sigma_m = 0.0;
    /// Length of the correction of pose and velocity in standard deviations of the inertial prior's error, per root of
    /// its nine unknowns: 1 at most, in the mean, where prior and surfaces are what they claim to be; 0: not aligned.
    double innovation = 0.0;
    int iterations = 0;
    int lost_sweeps = 0;  ///< rejected in a row up to this sweep, this one included
    /// Direction in which the surfaces hold the pose least: (position, attitude scaled by the rms lever) in W, unit.
    Eigen::Matrix<double, 6, 1> weakest_direction = Eigen::Matrix<double, 6, 1>::Zero();
    Eigen::Vector3d saturation_deficit_rad_s =
        Eigen::Vector3d::Zero();        ///< added to the clipped axes, along the sign of the rate; mean of the knots
    std::size_t points_used = 0;        ///< finite returns in range that are not the robot's own
    std::size_t points_alone = 0;       ///< of these, that nothing beside them bears out, and that are not used further
    std::size_t points_registered = 0;  ///< one per voxel of the rest
    std::size_t map_points_added = 0;
  };

  explicit LidarInertialOdometry(const Params& params);
  ~LidarInertialOdometry();
  LidarInertialOdometry(LidarInertialOdometry&&) noexcept;
  LidarInertialOdometry& operator=(LidarInertialOdometry&&) noexcept;
  /// Copies carry all state: continuing from a copy gives bit-identical results.
  LidarInertialOdometry(const LidarInertialOdometry&);
  LidarInertialOdometry& operator=(const LidarInertialOdometry&);

  /// Adds a sample with the angular velocity that a rate method gave for it. On trouble the state is unchanged:
  /// `non_finite`, `time_order`, or `out_of_range` when `rate` belongs to another time. A gap is bridged by the sample
  /// after it, and the prior loosened accordingly.
  Status add_imu(const ImuSample& sample, const RateState& rate);

  /// What an odometer says of the velocity at the start of the next sweep, which is where the last one ended: in IMU
  /// axes, and its standard deviation per axis. It takes the place of the velocity that the last sweep ended with, for
  /// that one sweep. `non_finite`, or `out_of_range` where the standard deviation is not above 0; nothing is changed.
  Status add_velocity(const Eigen::Vector3d& v_WI_I_m_s, double sigma_m_s);

  /// Registers a sweep of points fired in [start_ns, end_ns]; sweeps do not overlap. Returns that are NaN are misses.
  ///
  /// Trouble that leaves the state as it was: `time_order` (end before start, or start before the last sweep's end),
  /// `too_few` (IMU samples do not cover the sweep), `out_of_range` (an offset beyond the sweep).
  /// Trouble after which the pose is the inertial prior and the verdict `rejected`: `empty` (no points), `non_finite`
  /// (no finite point), `too_few` (none in range), `degenerate` (all points bear one time stamp though the sweep
  /// lasts).
  Status add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points, SweepReport& report);

  /// Pose and velocity at the last of further samples, which are not added: from the last sweep's end by inertia alone,
  /// with covariance; there where nothing came after it. For who needs a pose before the sweep is there, or its rates
  /// are settled. Trouble: `empty` before the first sweep, and that of add_imu. O(samples since the last sweep).
  Status predict(std::span<const ImuSample> samples, std::span<const RateState> rates, PoseState& pose) const;

  /// Calibration as estimated so far, and the covariance of its errors; the given one, and 0, where not estimated.
  SweepCalibration calibration() const;
  SweepCalibration::Covariance calibration_covariance() const;
  /// What weighs the calibration against the next sweep, wider than its errors since a point counts for less than it
  /// tells: what another run over the same data starts from.
  SweepCalibration::Covariance calibration_weight() const;

  /// Pose at any time within the window of sweeps, by all that has been seen. `out_of_range` outside of it.
  Status pose_at(TimeNs time_ns, PoseState& pose) const;

  /// Poses of the sweeps in the window that have not had their last word yet, as they stand, oldest first: with
  /// SweepReport::smoothed, the whole trajectory.
  std::vector<std::vector<PoseState>> open_trajectories() const;

  /// Memory held by the map [bytes].
  std::size_t map_bytes() const;

  /// The map within map_radius_m, with normals from the nearest neighbours that look towards where the point was seen
  /// from. O(number of points).
  std::vector<MapPoint> map() const;

  /// All of it but what the caller gave for its work (`parallel_for`), into one of the same parameters: a state that
  /// was loaded goes on with the same bits. What another run may have taught of the parameters (the mounting, the
  /// clock, their deviations) comes with it; that the others are the same is for the caller to see to. On trouble,
  /// which the reader tells, this is as it was.
  void save(StateWriter& out) const;
  void load(StateReader& in);
  void describe(StateLayout& out) const;

  struct Impl;  ///< for the library's own sources

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble
