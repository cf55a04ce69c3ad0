// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "tumble/angular_velocity/rail_plane.hpp"
#include "tumble/attitude/detail/force_errors.hpp"
#include "tumble/attitude/detail/imu_merge_expert_params.hpp"
#include "tumble/attitude/detail/imu_merge_state.hpp"
#include "tumble/attitude/detail/rate_recovery.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// Of ImuMerge.
struct ImuMergeParams {
  static constexpr int kImus = ImuMergeState::kImus;
  std::array<Eigen::Isometry3d, kImus> T_CI{};  ///< mountings; the first `count` are used
  int count = 1;
  double rate_noise_rad_s = 0.01;  ///< of the mean over a window
  double window_s = 4e-3;          ///< over which readings are averaged beforehand
  double offset_sigma_s = 3e-3;    ///< prior of a unit's time offset; zero: none
  double gyro_range_rad_s = 1e3;   ///< readings from here on are at the rail
  double accel_range_m_s2 = 1e5;
  double gap_max_s = 1.0;
  /// Along what the elements of each unit sense (RailPlaneFinder).
  std::array<ElementRows, kImus> gyro_elements{}, accel_elements{};

  using Expert = ImuMergeExpertParams;
  Expert expert = {};  ///< what few need

  /// Every number of it, stated once.
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.count, {"count", "1", 1, kImus, "number of IMUs in use"});
    visit(p.rate_noise_rad_s,
          {"rate_noise_rad_s", "rad/s", 1e-12, 10.0, "standard deviation of the mean rate over a window"});
    visit(p.window_s, {"window_s", "s", 0.0, 0.1, "duration over which readings are averaged before merging"});
    visit(p.offset_sigma_s,
          {"offset_sigma_s", "s", 0.0, 0.1, "prior standard deviation of an IMU's time offset; 0: no offset"});
    visit(p.gyro_range_rad_s,
          {"gyro_range_rad_s", "rad/s", 1e-12, 1e3, "gyro readings from this value on are at the rail"});
    visit(p.accel_range_m_s2,
          {"accel_range_m_s2", "m/s^2", 1e-12, 1e5, "accelerometer readings from this value on are at the rail"});
    visit(p.gap_max_s, {"gap_max_s", "s", 1e-9, 1e4,
                        "longest allowed time between two samples; a longer gap ends the run with an error"});
    visit.group("", p.expert);
  }
};

/// Several IMUs on one rigid body as one: in common axes C, at the mean of their positions.
///
/// On a rigid body specific force is linear in the position, so the mean of the forces is exactly the force at the mean
/// place: no angular acceleration is needed. Where three or more agree but for one, that one is left out of the sample,
/// and what its position would have added is made up for with the rate of the others. Each unit's own bias, scale,
/// misalignment and time offset about the mean are estimated by a small Kalman filter while the body turns; the time
/// offset is taken out when it is beyond doubt, the others average out. The accelerometers' do not in fast turns, where
/// large forces cancel in the mean: they are told apart and taken out (ForceErrors).
///
/// A unit whose accelerometer stands at its rail is left out of the force, and one that may have met it within a sample
/// and disagrees with the others; where most are doubtful, the merged force is flagged as clipped. Where
/// the gyros do, three units or more tell the rate by what the turning does to their accelerometers (RateRecovery); the
/// merged sample's clip flags say when they could not. Fewer units leave out a clipped one where another is free; where
/// none is, the merged sample carries the flags, of all axes of C that a clipped one has a part in. Clipped is what is
/// flagged or reads beyond the range: rails below it, tilted ones above all, are for whoever judges the units
/// (ClippingFinder) to flag.
///
/// Decided and learnt is by means over window_s, whatever the rate of the IMUs: they have one bandwidth, and so the
/// tolerances one meaning. A reading that is itself as long is taken as it is; of an axis that was at its rail within
/// the window the mean is a bound, as a reading at the rail is.
///
/// A unit whose reading is not finite is absent. One whose gyro or accelerometer repeats itself while the others move,
/// or its accelerometer while gravity turns, is frozen, and left out until it has moved again for a while; one that is
/// off from the others for long (scale, axes, unit) is left out for good, as long as two others remain. Equal readings
/// at rest are no sign of either.
///
/// Not modelled: clocks of different rates, an error that all units share.
class ImuMerge {
 public:
  static constexpr int kImus = ImuMergeState::kImus;
  static constexpr int kLearnFrom = ImuMergeState::kLearnFrom;
  static constexpr int kErrors = ImuMergeUnit::kErrors;

  using Params = ImuMergeParams;

  using Hold = ImuHold;
  using Unit = ImuMergeUnit;
  using State = ImuMergeState;

  explicit ImuMerge(const Params& params);

  /// What the forces differ by from unit to unit, as a share of what the turning makes of their positions: 1 when all
  /// is as it should be, -1 when the accelerometers' sign is flipped. None while the body has not turned enough to
  /// tell.
  static std::optional<double> arm_share(const State& state);

  /// `out_of_range` with the seconds for which they have repeated themselves where all units that were heard last are
  /// frozen (their readings are merged as they are then); `ok` otherwise.
  Status verdict(const State& state) const;

  /// Position of the merged IMU in C.
  Eigen::Vector3d p_C_m() const { return p_C_m_; }

  /// `samples` are those of all units at one time (their time stamps are the first's); `merged` is in C, the mean over
  /// the window that they close, and empty where they close none. On trouble, `too_few` when there are not `count`
  /// samples or none is finite, the state is unchanged and `merged` empty. O(count), no allocation.
  Status step(std::span<const ImuSample> samples, State& state, std::optional<ImuSample>& merged) const;

 private:
  using Vectors = std::array<Eigen::Vector3d, kImus>;

  using Flags = std::array<bool, kImus>;

  using Readings = std::array<ImuSample, kImus>;  ///< means over a window; flags of the axes that met a rail in it

  void gather(std::span<const ImuSample> samples, double dt_s, State& state) const;
  ImuSample merge(State& state) const;
  Flags choose(const Readings& readings, const Flags& present, const Vectors& rates, const Vectors& forces, double h,
               State& state) const;
  ImuSample mean_of_used(const Vectors& rates, const Vectors& forces, const Flags& used, double h,
                         const State& state) const;
  std::uint8_t flags_of(const Readings& readings, const Flags& which) const;
  void close_windows(const Flags& present, const Vectors& rates, const Vectors& forces, bool all_used,
                     const ImuSample& merged, State& state) const;
  void learn(const Vectors& rates, State& state) const;
  void watch_holds(const Flags& present, const Vectors& rates, const Vectors& forces, double dt_s, TimeNs time_ns,
                   State& state) const;
  void watch_misfits(const Flags& present, const Vectors& rates, const Vectors& forces, TimeNs time_ns,
                     State& state) const;
  static Eigen::Vector3d median(const Vectors& values, const Flags& which);
  void leave_out_subsample_saturated(const Readings& samples, const Flags& present, const Vectors& forces,
                                     const Eigen::Vector3d& rate, double h, State& state, Flags& used) const;
  void recover(const Readings& readings, const Flags& present, double h, State& state, ImuSample& merged) const;
  static ForceErrors::Params force_params(const Params& params);
  static RateRecovery::Params recovery_params(const Params& params);

  Params params_;
  Eigen::Vector3d p_C_m_ = Eigen::Vector3d::Zero();
  ForceErrors forces_;
  RateRecovery recovery_;
};

}  // namespace tumble
