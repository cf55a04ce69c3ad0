// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "tumble/angular_velocity/detail/rail_plane.hpp"
#include "tumble/attitude/detail/force_errors.hpp"
#include "tumble/attitude/detail/imu_merge_expert_params.hpp"
#include "tumble/attitude/detail/imu_merge_state.hpp"
#include "tumble/attitude/detail/rate_recovery.hpp"
#include "tumble/attitude/detail/unit_sign_check.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/sensor_health.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// ImuMergeParams contains the parameters of ImuMerge.
struct ImuMergeParams {
  static constexpr int kImus = ImuMergeState::kImus;
  /// Pose of each IMU in the common axes C; only the first `count` entries are used.
  std::array<Eigen::Isometry3d, kImus> T_CI{};
  int count = 1;
  double rate_noise_rad_s = 0.01;  ///< standard deviation of the mean rate over a window
  double window_s = 4e-3;          ///< averaging time of the readings
  double offset_sigma_s = 3e-3;    ///< prior standard deviation of each IMU's time offset; 0: synchronous clocks
  double gyro_range_rad_s = 1e3;   ///< readings at or above this rate are saturated
  double accel_range_m_s2 = 1e5;
  double gap_max_s = 1.0;
  /// Sensing directions of each IMU's gyro and accelerometer, as RailPlaneFinder finds them.
  std::array<SensingDirections, kImus> gyro_elements{}, accel_elements{};

  using Expert = ImuMergeExpertParams;
  Expert expert = {};  ///< rarely changed parameters

  /// Calls `visit` once for each parameter, with its value, name, unit, bounds and meaning.
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.count, {"count", "1", 1, kImus, "number of IMUs in use"});
    visit(p.rate_noise_rad_s,
          {"rate_noise_rad_s", "rad/s", 1e-12, 10.0, "standard deviation of the mean rate over a window"});
    visit(p.window_s, {"window_s", "s", 0.0, 0.1, "duration over which readings are averaged before merging"});
    visit(p.offset_sigma_s,
          {"offset_sigma_s", "s", 0.0, 0.1, "prior standard deviation of an IMU's time offset; 0: no offset"});
    visit(p.gyro_range_rad_s,
          {"gyro_range_rad_s", "rad/s", 1e-12, 1e3, "gyro readings from this value on count as saturated"});
    visit(p.accel_range_m_s2,
          {"accel_range_m_s2", "m/s^2", 1e-12, 1e5, "accelerometer readings from this value on count as saturated"});
    visit(p.gap_max_s,
          {"gap_max_s", "s", 1e-9, 1e4, "maximum time between two samples; a longer gap ends the run with an error"});
    visit.group("", p.expert);
  }
};

/// Merges several IMUs on one rigid body into one IMU, in common axes C, at the mean position of the IMUs.
///
/// On a rigid body, the specific force is linear in position. The mean force of all IMUs is therefore exactly the force
/// at their mean position, for any angular acceleration. If one IMU disagrees while three or more IMUs agree, ImuMerge
/// excludes the disagreeing IMU from the sample. The exclusion shifts the mean position of the IMUs. ImuMerge corrects
/// the mean force for this shift of the position, using the rate of the remaining IMUs. While the body rotates, a
/// Kalman filter estimates each IMU's bias, scale, misalignment and time offset relative to the mean of all IMUs.
/// ImuMerge corrects significant time offsets; averaging reduces the remaining gyro errors. In fast rotation, averaging
/// does not reduce accelerometer errors, because large opposite forces cancel in the mean. ImuMerge therefore estimates
/// and corrects the accelerometer errors.
///
/// ImuMerge excludes an IMU with a saturated accelerometer from the mean force. ImuMerge also excludes an IMU that
/// disagrees with the others and may have been saturated during a part of the sample. If most IMUs may be saturated,
/// the merged force is flagged as clipped. If the gyros are saturated, ImuMerge computes the rate from the force
/// differences between three or more IMUs. If the computation of the rate fails, the merged sample has clip flags. With
/// one or two IMUs, ImuMerge excludes an IMU with a clipped gyro while the other IMU is unsaturated. If all gyros are
/// saturated, ImuMerge flags every axis of C to which a clipped axis contributes. ImuMerge treats a reading as clipped
/// if the reading is flagged or beyond the stated range. The caller must flag readings at lower saturation limits and
/// at tilted planes beforehand (ClippingFinder).
///
/// ImuMerge averages the readings over `window_s`. Bandwidth and tolerances therefore do not depend on the sample rate
/// of the IMUs. If the sample period is at least `window_s`, ImuMerge uses the readings without averaging. If an axis
/// was saturated within the window, the mean of the axis is a lower bound.
///
/// ImuMerge treats an IMU whose reading is not finite as absent. An IMU is frozen if its gyro or accelerometer repeats
/// one reading while the readings of other IMUs change. An IMU is also frozen if its accelerometer repeats one reading
/// while the direction of gravity rotates. ImuMerge excludes a frozen IMU until its readings have changed for
/// 0.5 s. ImuMerge permanently excludes an IMU that disagrees for long (scale, axes, unit of measurement),
/// as long as two other IMUs remain. Repeated readings of a body at rest do not count as frozen.
///
/// ImuMerge assumes that all clocks have the same rate, and does not detect an error that all IMUs share.
class ImuMerge {
 public:
  static constexpr int kImus = ImuMergeState::kImus;
  static constexpr int kAccelerationWindows = ImuMergeState::kAccelerationWindows;
  static constexpr int kErrorCount = ImuMergeUnit::kErrorCount;

  using Params = ImuMergeParams;

  using Repetition = ImuRepeat;
  using Unit = ImuMergeUnit;
  using State = ImuMergeState;

  explicit ImuMerge(const Params& params);

  /// Returns the ratio of measured to expected force differences between IMUs. The expected differences follow from
  /// rotation and positions. The ratio is 1 if forces and rotation agree, and -1 if the sign of the accelerometers is
  /// inverted. The result is empty until the body has rotated enough.
  static std::optional<double> lever_arm_agreement(const State& state);

  /// Returns `out_of_range` with the duration [s] if all active IMUs are frozen, and otherwise `ok`. While all IMUs are
  /// frozen, step() merges their readings unchanged.
  static Status verdict(const State& state);
  /// Adds a finding for each IMU that is frozen or disagrees with the other IMUs.
  static void add_finding(const Unit& unit, const std::string& name, SensorHealth& health);
  /// Adds findings about all IMUs together: exchanged or inverted axes (UnitSignCheck), and a wrong scale
  /// (lever_arm_agreement()). `gyro_confirmed` states whether another check confirms the scale of the gyros.
  static void add_findings(const std::optional<UnitSignCheck::Detected>& mislabelled_axes,
                           const std::optional<double>& lever_arm_agreement, bool gyro_confirmed, SensorHealth& health);

  /// Returns the position of the merged IMU in the common axes C [m].
  Eigen::Vector3d p_C_m() const { return p_C_m_; }

  /// Processes simultaneous samples of all IMUs, with the time stamp of the first IMU. The output `merged` is the mean
  /// over the averaging window in axes C, or empty while the window is incomplete. Returns `too_few` if `samples` does
  /// not contain `count` samples, or if none of the samples is finite. On error, the state is unchanged and `merged` is
  /// empty. Cost: O(count), no allocation.
  Status step(std::span<const ImuSample> samples, State& state, std::optional<ImuSample>& merged) const;

 private:
  using Vectors = std::array<Eigen::Vector3d, kImus>;

  using UnitMask = std::array<bool, kImus>;

  /// Mean readings over a window, with flags of the axes that were saturated in the window.
  using Readings = std::array<ImuSample, kImus>;

  void accumulate_window(std::span<const ImuSample> samples, double dt_s, State& state) const;
  ImuSample merge(State& state) const;
  UnitMask select_units(const Readings& readings, const UnitMask& present, const Vectors& rates, const Vectors& forces,
                        double h, State& state) const;
  ImuSample mean_of_used(const Vectors& rates, const Vectors& forces, const UnitMask& used, double h,
                         const State& state) const;
  std::uint8_t combined_flags(const Readings& readings, const UnitMask& which) const;
  void close_windows(const UnitMask& present, const Vectors& rates, const Vectors& forces, bool all_used,
                     const ImuSample& merged, State& state) const;
  void calibrate(const Vectors& rates, State& state) const;
  void detect_frozen_units(const UnitMask& present, const Vectors& rates, const Vectors& forces, double dt_s,
                           TimeNs time_ns, State& state) const;
  void detect_disagreeing_units(const UnitMask& present, const Vectors& rates, const Vectors& forces, TimeNs time_ns,
                                State& state) const;
  static Eigen::Vector3d median(const Vectors& values, const UnitMask& which);
  void exclude_subsample_saturated(const Readings& samples, const UnitMask& present, const Vectors& forces,
                                   const Eigen::Vector3d& rate, double h, State& state, UnitMask& used) const;
  void recover(const Readings& readings, const UnitMask& present, double h, State& state, ImuSample& merged) const;
  static ForceErrors::Params force_params(const Params& params);
  static RateRecovery::Params recovery_params(const Params& params);

  Params params_;
  Eigen::Vector3d p_C_m_ = Eigen::Vector3d::Zero();
  ForceErrors forces_;
  RateRecovery recovery_;
};

}  // namespace tumble
