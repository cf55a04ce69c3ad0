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
#include "tumble/attitude/imu_merge.hpp"
#include "tumble/common/detail/outlier_filter.hpp"
#include "tumble/common/pose.hpp"
#include "tumble/common/sample_clock.hpp"
#include "tumble/odometry/detail/unit_rails.hpp"
#include "tumble/odometry/imu_sheet.hpp"
#include "tumble/rolling/rolling_smoother.hpp"

namespace tumble {

/// Pose of a rolling sphere from one to four IMUs, through grip, slip, bumps and slopes: live, and smoothed with what
/// follows within `lag_s`. UnitRails flags what a device clips without saying so, ImuMerge makes the IMUs one,
/// RollingSmoother (with its RollingFilter) does the rest.
///
/// World: z up, origin at the sphere's centre at the first sample, yaw 0 there. Begin with a second of rest. State of
/// half a megabyte, 0.1 for each IMU, and 11 KiB for each 0.02 s of lag; a sample that ends no block
/// (RollingSmoother::Params::block_s) allocates nothing once the first have come, but for poses that nobody takes. A
/// call needs 64 KiB of stack at most. No threads, no files, no printing. Copies carry all state. Not modelled: see the
/// classes named.
class RollingOdometry {
 public:
  /// One IMU of the sphere.
  struct Unit {
    ImuSheet sheet;
    /// The unit in axes of the sphere, from its centre: a point in axes of the sphere is T_BI times one of the unit's.
    /// It lies within the sphere.
    Eigen::Isometry3d T_BI = Eigen::Isometry3d::Identity();
  };
  struct Params {
    double radius_m = 0.0;    ///< has no default
    std::vector<Unit> units;  ///< 1 to ImuMerge::kImus; has no default
    /// Of the place that T_BI counts from, about the true centre: standard deviation. It is estimated.
    double centre_sigma_m = 6e-3;
    double gravity_m_s2 = 9.80665;
    double lag_s = 0.0;  ///< take() gives poses smoothed with what follows for so long; 0: live poses

    /// What few need. Of the same numbers as above those above count.
    struct Expert {
      ImuMerge::Params merge;
      RollingSmoother::Params rolling;
      SampleClock::Params stamps;  ///< of stamps that a host put on the samples
    } expert;

    /// Every number of it, stated once.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.radius_m, {"radius_m", "m", 1e-3, 100.0, "of the sphere", Rank::first});
      visit(p.centre_sigma_m,
            {"centre_sigma_m", "m", 0.0, 10.0, "place that the units are given from, about the centre", Rank::first});
      visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 0.1, 100.0, "strength of gravity", Rank::first});
      visit(p.lag_s, {"lag_s", "s", 0.0, 1e3, "poses are smoothed with what follows for so long", Rank::first});
      visit.group("merge_", p.expert.merge);
      visit.group("rolling_", p.expert.rolling);
      visit.group("stamps_", p.expert.stamps);
    }
  };
  struct Pose {
    PoseState pose;  ///< of the sphere's centre, in axes of the sphere; of a live one the attitude has no covariance
    RollingMode mode = RollingMode::grip;
    bool at_rest = false;
    bool uncertain = false;  ///< in an event that made the position uncertain (RollingModeParams::uncertain_m)
  };

  /// Throws InvalidParams on a parameter outside of its bound.
  explicit RollingOdometry(const Params& params);
  RollingOdometry(const RollingOdometry& other);
  RollingOdometry& operator=(const RollingOdometry& other);
  RollingOdometry(RollingOdometry&&) noexcept = default;
  RollingOdometry& operator=(RollingOdometry&&) noexcept = default;
  ~RollingOdometry() = default;

  /// Takes what all units read at one time (the first's stamp counts, and where a host jitters what SampleClock makes
  /// of it); one that has nothing to say gives NaN. On
  /// trouble the state is as it was: `too_few` (units, or one that has something to say), `time_order`, `degenerate`
  /// (no gravity in the first sample), `gap` (more than a second: the way is not known any more, and the run is over
  /// until reset()), `out_of_range` after finish() and where the only unit that is heard has a frozen axis.
  /// OutlierFilter rejects single wild readings of each unit. It may hold the samples of all units until the next ones
  /// come: newest() is then one sample older.
  Status add_imus(std::span<const ImuSample> samples);
  /// The same of a sphere with one.
  Status add_imu(const ImuSample& sample) { return add_imus({&sample, 1}); }

  /// Pose at the newest sample by what came before it. Nothing before the first.
  std::optional<Pose> newest() const;

  /// The next pose of those given out once each, in order of time: lag_s old, or live ones without a lag.
  std::optional<Pose> take();

  /// Smooths what is still within the lag: the run has ended, until reset().
  void finish();

  /// Begins a new run: at the origin, at rest. Poses that wait for take() stay.
  void reset();

  /// Whether the units can be believed just now: `ok`, or `out_of_range` with unit and axis by name that has frozen
  /// (FrozenAxes), for how long and the bound. What that unit reads is left out meanwhile; where it is the only one
  /// that is heard, add_imus() says so and takes nothing in.
  Status doubt() const { return doubt(frozen_); }

  /// What the IMUs say of each other: frozen, disagreeing, late ones.
  const ImuMerge::State& units() const { return *merge_state_; }

  /// Number of readings that OutlierFilter rejected, over all units.
  std::size_t rejected_readings() const;

  /// As TumblingOdometry::mended_jitter_s: of the stamps [s].
  std::optional<double> mended_jitter_s() const;

  /// As TumblingOdometry::save and load: a state of up to a megabyte, less at rest, and what the lag holds.
  std::vector<std::byte> save() const;
  Status load(std::span<const std::byte> bytes);
  static Status saved_params(std::span<const std::byte> bytes, Params& params);

  /// Stated once, in the library's own sources: state_visitor.hpp.
  template <class Self, class Visitor>
  static void members(Self& s, Visitor& visit);

 private:
  using Frozen = std::array<FrozenAxes::State, ImuMerge::kImus>;
  using Outliers = std::array<OutlierFilter::State, ImuMerge::kImus>;

  RollingOdometry(const Params& params, const ImuMerge::Params& merged);

  Status add_held(std::span<const ImuSample> next);
  Status add_inliers(std::span<const ImuSample> samples);
  Status take_in(const ImuSample& merged);
  Status leave_out_frozen(const Frozen& frozen, std::span<ImuSample> samples) const;
  Status doubt(const Frozen& frozen) const;

  Params params_;
  SampleClock clock_;
  SampleClock::State stamps_;  ///< of the samples taken in
  ImuMerge merge_;
  RollingSmoother smoother_;
  UnitRails rails_;
  std::unique_ptr<ImuMerge::State> merge_state_;
  std::unique_ptr<ImuMerge::State> merged_state_;  ///< memory for the next one
  std::unique_ptr<RollingSmoother::State> state_;
  UnitRails::State rails_state_;
  std::vector<OutlierFilter> filters_;  ///< of the units
  Outliers outliers_{};
  std::optional<UnitRails::Samples> held_;  ///< of all units, while OutlierFilter holds one of them
  std::vector<FrozenAxes> watches_;         ///< of the units
  Frozen frozen_{};
  std::vector<RollingEstimate> done_;
  std::size_t taken_ = 0;
  bool live_ = true, finished_ = false;
};

}  // namespace tumble
