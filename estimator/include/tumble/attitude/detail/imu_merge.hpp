// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "tumble/attitude/detail/imu_merge_state.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Fuses several IMUs on one rigid body to one IMU, in common axes C, at the mean position of the IMUs.
///
/// The fused specific force is the mean over the IMUs, corrected for excluded IMUs. While the body rotates, ImuMerge
/// estimates bias, scale, misalignment and time offset of each gyro relative to the mean of all gyros. Significant time
/// offsets and accelerometer errors are corrected. If all gyros are saturated, the differences between the specific
/// forces of three or more IMUs determine the rate. The equations are in docs/maths/imu_merge.md.
///
/// The fused sample has clip flags if saturation prevents a correct rate or force. Readings count as saturated if they
/// have a clip flag or exceed the stated range. The caller must flag readings at lower or tilted saturation limits
/// beforehand (ClippingFinder).
///
/// ImuMerge excludes an IMU with a saturated accelerometer or with a reading that is not finite. ImuMerge also excludes
/// an IMU that disagrees with three or more agreeing IMUs, permanently if the disagreement lasts. A frozen IMU, which
/// repeats one reading during motion, is excluded until its readings have changed for 0.5 s.
///
/// The readings are averaged over `kWindow_s`, unless the sample period is at least `kWindow_s`. ImuMerge assumes that
/// the clocks of the IMUs have the same rate, and does not detect an error that all IMUs share.
class ImuMerge {
 public:
  static constexpr int kImus = ImuMergeState::kImus;
  static constexpr int kAngularAccelerationWindows = ImuMergeState::kAngularAccelerationWindows;
  static constexpr int kErrorCount = MergedImuState::kErrorCount;

  using Setup = ImuMergeSetup;

  using Repetition = RepeatedImuReading;
  using Unit = MergedImuState;
  using State = ImuMergeState;

  /// Throws InvalidParams if the number of IMUs, a range or a mounting is out of bounds.
  explicit ImuMerge(const Setup& setup);

  /// Returns the ratio of the measured differences between specific forces to the differences that follow from rotation
  /// and positions of the IMUs. The ratio is 1 for correct IMUs, -1 for inverted accelerometers, and empty before
  /// enough rotation.
  static std::optional<double> lever_arm_agreement(const State& state);

  /// Returns `out_of_range` with the duration [s] if all IMUs repeat one reading. Meanwhile, step() fuses their
  /// readings unchanged.
  static Status verdict(const State& state);
  static void add_finding(const Unit& unit, const std::string& name, SensorHealth& health);
  /// Adds findings about axes that are exchanged or inverted in all IMUs (MultiImuSignCheck), and about a wrong scale
  /// (lever_arm_agreement()). `gyro_confirmed` states whether another check confirms the scale of the gyros.
  static void add_findings(const std::optional<MultiImuSignCheck::DetectedMirroring>& mislabelled_axes,
                           const std::optional<double>& lever_arm_agreement, bool gyro_confirmed, SensorHealth& health);

  Eigen::Vector3d mean_imu_position_m() const { return mean_imu_position_m_; }

  /// Processes simultaneous samples of all IMUs. `merged` is the mean over `kWindow_s` in axes C, with the time stamp
  /// of the first IMU; empty between two means. Returns `insufficient_data` if `samples` does not contain `count`
  /// samples, or if none of the samples is finite. On error, the state is unchanged and `merged` is empty. Cost:
  /// O(count), no allocation.
  Status step(std::span<const ImuSample> samples, State& state, std::optional<ImuSample>& merged) const;

 private:
  using Vectors = std::array<Eigen::Vector3d, kImus>;

  using ImuMask = std::array<bool, kImus>;

  /// Mean reading of each IMU over a window, with the clip flags of all readings.
  using Readings = std::array<ImuSample, kImus>;

  void accumulate_window(std::span<const ImuSample> samples, double dt_s, State& state) const;
  ImuSample merge(State& state) const;
  ImuMask select_agreeing_imus(const Readings& readings, const ImuMask& present, const Vectors& rates,
                               const Vectors& forces, double h, State& state) const;
  ImuSample mean_of_selected_imus(const Vectors& rates, const Vectors& forces, const ImuMask& used, double h,
                                  const State& state) const;
  std::uint8_t combined_flags(const Readings& readings, const ImuMask& which) const;
  void close_comparison_windows(const ImuMask& present, const Vectors& rates, const Vectors& forces, bool all_used,
                                const ImuSample& merged, State& state) const;
  void calibrate(const Vectors& rates, State& state) const;
  void detect_frozen_units(const ImuMask& present, const Vectors& rates, const Vectors& forces, double dt_s,
                           TimeNs time_ns, State& state) const;
  void detect_disagreeing_units(const ImuMask& present, const Vectors& rates, const Vectors& forces, TimeNs time_ns,
                                State& state) const;
  static Eigen::Vector3d median(const Vectors& values, const ImuMask& which);
  void exclude_partly_saturated(const Readings& samples, const ImuMask& present, const Vectors& forces,
                                const Eigen::Vector3d& rate, double h, State& state, ImuMask& used) const;
  void recover_saturated_rate(const Readings& readings, const ImuMask& present, double h, State& state,
                              ImuSample& merged) const;

  Setup setup_;
  Eigen::Vector3d mean_imu_position_m_;
  ForceErrors forces_;
  AngularRateRecovery rate_recovery_;
};

}  // namespace tumble
