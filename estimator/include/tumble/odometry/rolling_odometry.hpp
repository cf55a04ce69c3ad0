// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/frozen_axes.hpp"
#include "tumble/attitude/detail/rest_gravity.hpp"
#include "tumble/attitude/imu_merge.hpp"
#include "tumble/common/detail/outlier_filter.hpp"
#include "tumble/common/pose.hpp"
#include "tumble/common/sample_clock.hpp"
#include "tumble/odometry/detail/stamp_order.hpp"
#include "tumble/odometry/detail/unit_rails.hpp"
#include "tumble/odometry/imu_sheet.hpp"
#include "tumble/rolling/rolling_smoother.hpp"

namespace tumble {

/// Estimates the pose of a rolling sphere from one to four IMUs, through grip, slip, bumps and slopes. The poses are
/// live, or smoothed with the data of the following `lag_s`. UnitRails flags readings that a device clips without
/// reporting saturation, ImuMerge fuses the IMUs, and RollingSmoother (with its RollingFilter) estimates the motion.
///
/// World: z up, origin at the sphere's centre at the first sample, yaw 0 at the first sample. Start with one second at
/// rest.
///
/// Cost: the state takes half a megabyte, plus 0.1 MB per IMU and 11 KiB per 0.02 s of lag. Poses are computed in
/// blocks (RollingSmoother::Params::block_s). A sample inside a block allocates nothing after start-up, except for
/// poses not yet fetched by take(). A call needs at most 64 KiB of stack. The class uses no threads and no files and
/// prints nothing. Copies contain the complete state. The limitations of ImuMerge, RollingFilter and RollingSmoother
/// apply.
class RollingOdometry {
 public:
  /// One IMU of the sphere.
  struct Unit {
    ImuSheet sheet;
    /// Pose of the IMU, which is inside the sphere, in axes from the sphere's centre: x_B = T_BI x_I.
    Eigen::Isometry3d T_BI = Eigen::Isometry3d::Identity();
  };
  struct Params {
    double radius_m = 0.0;    ///< required, no default
    std::vector<Unit> units;  ///< 1 to ImuMerge::kImus; required, no default
    /// Standard deviation of the origin of T_BI about the sphere's true centre. The offset is estimated.
    double centre_sigma_m = 6e-3;
    double gravity_m_s2 = 9.80665;
    double lag_s = 0.0;  ///< lag of the smoothed poses of take(); 0: live poses

    /// Parameters that few users change. If Params and Expert contain the same number, the value in Params has
    /// priority.
    struct Expert {
      ImuMerge::Params merge;
      RollingSmoother::Params rolling;
      SampleClock::Params stamps;  ///< correction of stamps that a host assigned
    } expert;

    /// Calls the visitor with the value, name, unit, bounds and meaning of every parameter (common/parameters.hpp).
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.radius_m, {"radius_m", "m", 1e-3, 100.0, "radius of the sphere", Rank::first});
      visit(p.centre_sigma_m,
            {"centre_sigma_m", "m", 0.0, 10.0,
             "standard deviation of the stated centre: reference point of the IMU positions", Rank::first});
      visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 0.1, 100.0, "strength of gravity", Rank::first});
      visit(p.lag_s,
            {"lag_s", "s", 0.0, 1e3, "time that a pose waits for later data before it is smoothed", Rank::first});
      visit.group("merge_", p.expert.merge);
      visit.group("rolling_", p.expert.rolling);
      visit.group("stamps_", p.expert.stamps);
    }
  };
  struct Pose {
    PoseState pose;  ///< sphere's centre, sphere axes; live poses have no attitude covariance
    RollingMode mode = RollingMode::grip;
    bool at_rest = false;
    bool uncertain = false;  ///< an event (RollingModeParams::uncertain_m) or a restart made the position uncertain
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit RollingOdometry(const Params& params);
  RollingOdometry(const RollingOdometry& other);
  RollingOdometry& operator=(const RollingOdometry& other);
  RollingOdometry(RollingOdometry&&) noexcept = default;
  RollingOdometry& operator=(RollingOdometry&&) noexcept = default;
  ~RollingOdometry() = default;

  /// Processes simultaneous readings of all units. The stamp of the first unit counts, corrected by SampleClock if a
  /// host's stamps jitter. A unit without a reading is passed as NaN. OutlierFilter rejects single wild readings of
  /// each unit. OutlierFilter may delay the samples of all units by one; newest() is then one sample older. On error
  /// the state is unchanged. Errors are `too_few` (wrong number of units, or no reading), `time_order`, `degenerate`
  /// (no gravity in the first sample), `gap` and `out_of_range`. `out_of_range`: finish() was called, the stamp is beyond
  /// kStampMax_ns, or the only unit with readings has a frozen axis.
  ///
  /// A single wrong stamp costs one sample (StampOrder). After a gap of more than a second, the second sample restarts
  /// the run. If the clock steps back, samples are rejected with `time_order` for 0.2 s, and then the run restarts. A
  /// restart finishes the poses so far and continues as by reset(pose), at the newest pose. Later poses are `uncertain`.
  Status add_imus(std::span<const ImuSample> samples);
  /// Adds the sample of a sphere with one IMU. Errors are those of add_imus().
  Status add_imu(const ImuSample& sample) { return add_imus({&sample, 1}); }

  /// Returns the pose at the newest sample from all data so far. Returns nothing before the first sample.
  std::optional<Pose> newest() const;

  /// Returns the next pose in time order. No pose is returned twice. Poses are smoothed and lag_s old, or live if the
  /// lag is 0.
  std::optional<Pose> take();

  /// Ends the run and smooths the poses still within the lag. add_imus() then rejects samples until reset().
  void finish();

  /// Starts a new run at the origin and at rest. Poses not yet fetched by take() remain available, and the counts
  /// continue.
  void reset();
  /// Starts a new run as reset() does, at a known pose of the sphere. Position and heading are those of `T_WG`; the tilt
  /// is levelled at rest. Covariances are relative to this pose.
  void reset(const Eigen::Isometry3d& T_WG);

  /// Reports whether the readings are plausible now. Returns `ok`, or `out_of_range` with a finding. A finding is the
  /// unit and axis that is frozen (FrozenAxes) and the duration, or a force at rest that differs from gravity
  /// (RestGravity). The readings of a frozen unit are ignored. If no unfrozen unit has readings, add_imus() rejects the
  /// sample.
  Status health() const;

  /// Returns the state of the IMU fusion: frozen, disagreeing and delayed units.
  const ImuMerge::State& units() const { return *merge_state_; }

  /// Returns the number of readings that OutlierFilter rejected, over all units.
  std::size_t rejected_readings() const;
  /// Returns the number of restarts after a gap or after a clock that stepped back.
  std::size_t gaps() const { return gaps_; }
  /// Returns the jitter of the stamps [s]; see TumblingOdometry::estimated_jitter_s.
  std::optional<double> estimated_jitter_s() const;

  /// Save the state, load a saved state, and read saved parameters, as TumblingOdometry does. The size is up to a
  /// megabyte, less at rest, plus the lag's data.
  std::vector<std::byte> save() const;
  Status load(std::span<const std::byte> bytes);
  static Status saved_params(std::span<const std::byte> bytes, Params& params);

  /// Passes every member of the state to the visitor. The definition is in the library's sources (state_visitor.hpp).
  template <class Self, class Visitor>
  static void members(Self& s, Visitor& visit);

 private:
  using Frozen = std::array<FrozenAxes::State, ImuMerge::kImus>;
  using Outliers = std::array<OutlierFilter::State, ImuMerge::kImus>;

  RollingOdometry(const Params& params, const ImuMerge::Params& merged);

  void restart_at_newest();
  void place_start();
  RollingEstimate in_world(RollingEstimate estimate) const;
  Status add_held(std::span<const ImuSample> next);
  Status add_inliers(std::span<const ImuSample> samples);
  Status take_in(const ImuSample& merged);
  Status exclude_frozen(const Frozen& frozen, std::span<ImuSample> samples) const;
  Status frozen_axis(const Frozen& frozen) const;

  Params params_;
  StampOrder order_;
  StampOrder::State order_state_;
  SampleClock clock_;
  SampleClock::State stamps_;  ///< state of the clock from accepted samples
  ImuMerge merge_;
  RollingSmoother smoother_;
  UnitRails rails_;
  std::unique_ptr<ImuMerge::State> merge_state_;
  std::unique_ptr<ImuMerge::State> merged_state_;  ///< buffer for the next state
  std::unique_ptr<RollingSmoother::State> state_;
  UnitRails::State rails_state_;
  std::vector<OutlierFilter> filters_;  ///< one per unit
  Outliers outliers_{};
  std::optional<UnitRails::Samples> held_;  ///< samples of all units while OutlierFilter delays one of them
  std::vector<FrozenAxes> watches_;         ///< one per unit
  Frozen frozen_{};
  RestGravity gravity_;
  std::array<RestGravity::Size, ImuMerge::kImus> gravity_state_{};
  std::vector<RollingEstimate> done_;
  std::size_t taken_ = 0;
  std::optional<Eigen::Isometry3d> start_;  ///< pose given to reset(), until the first sample
  std::optional<Eigen::Isometry3d> T_WR_;   ///< pose of the run's origin; nothing: the world's origin
  std::size_t gaps_ = 0;
  bool restarted_ = false;  ///< the run continues after a gap or a step of the clock, so its position is uncertain
  bool live_ = true, finished_ = false;
};

}  // namespace tumble
