// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>

#include "tumble/attitude/force_errors.hpp"
#include "tumble/attitude/rate_recovery.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// Several IMUs on one rigid body as one: in common axes C, at the mean of their places.
///
/// On a rigid body specific force is linear in the place, so the mean of the forces is exactly the force at the mean
/// place: no angular acceleration is needed. Where three or more agree but for one, that one is left out of the sample,
/// and what its place would have added is made up for with the rate of the others. Each unit's own bias, scale,
/// misalignment and time offset about the mean are estimated by a small Kalman filter while the body turns; the time
/// offset is taken out when it is beyond doubt, the others average out. The accelerometers' do not in fast turns, where
/// large forces cancel in the mean: they are told apart and taken out (ForceErrors).
///
/// A unit whose accelerometer stands at its rail is left out of the force, and one that may have met it within a sample
/// and disagrees with the others; where most are doubtful, the merged force is flagged as clipped. Where
/// the gyros do, three units or more tell the rate by what the turning does to their accelerometers (RateRecovery); the
/// merged sample's clip flags say when they could not.
///
/// Not modelled: clocks of different rates, an error that all units share.
class ImuMerge {
 public:
  static constexpr int kImus = 4;
  static constexpr int kErrors = 13;  ///< of a unit's rate about the mean: bias, scale and misalignment, time offset

  struct Params {
    std::array<Eigen::Isometry3d, kImus> T_CI{};  ///< mountings; the first `count` are used
    int count = 1;                                ///< bound [1, kImus]
    double rate_tolerance_rad_s = 0.15;           ///< from the median, for a unit to be left out; bound (0, 1e3]
    double rate_tolerance_share = 0.03;           ///< more, as a share of the rate; bound [0, 1]
    double force_tolerance_m_s2 = 3.0;            ///< bound (0, 1e4]
    double rate_noise_rad_s = 0.01;               ///< of one reading; bound (0, 10]
    double offset_sigma_s = 3e-3;                 ///< prior of a unit's time offset; zero: none; bound [0, 0.1]
    double gyro_range_rad_s = 1e3;                ///< readings from here on are at the rail; bound (0, 1e3]
    double accel_range_m_s2 = 1e5;                ///< bound (0, 1e5]
    /// A reading from this share of the range on may hide a rail met within its sample; bound (0, 1].
    double hidden_share = 0.15;
    double hidden_force_m_s2 = 3.0;  ///< by which it then may disagree with another; bound (0, 1e4]
    double gap_max_s = 1.0;          ///< bound (0, 1e4]
  };

  /// Errors of one unit's rate about the mean of all.
  struct Unit {
    Eigen::Matrix<double, kErrors, 1> x = Eigen::Matrix<double, kErrors, 1>::Zero();
    Eigen::Matrix<double, kErrors, kErrors> P = Eigen::Matrix<double, kErrors, kErrors>::Zero();
    Eigen::Vector3d last_rate_rad_s = Eigen::Vector3d::Zero(), last_force_m_s2 = Eigen::Vector3d::Zero();
    double suspect_s = 0.0;     ///< for so long it is still left out of the force
    std::int64_t left_out = 0;  ///< samples
    double offset_s() const { return x[kErrors - 1]; }
    bool operator==(const Unit&) const = default;
  };
  struct State {
    std::array<Unit, kImus> units{};
    ForceErrors::State forces;
    RateRecovery::State recovery;
    Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();         ///< merged, last sample
    Eigen::Vector3d rate_before_rad_s = Eigen::Vector3d::Zero();  ///< and the one before
    std::int64_t samples = 0;
    TimeNs last_time_ns = 0;
    bool operator==(const State&) const = default;
  };

  explicit ImuMerge(const Params& params);

  /// Place of the merged IMU in C.
  Eigen::Vector3d p_C_m() const { return p_C_m_; }

  /// `samples` are those of all units at one time (their time stamps are the first's); `merged` is in C. On trouble,
  /// `too_few` when there are not `count` samples, state and `merged` are unchanged. O(count), no allocation.
  Status step(std::span<const ImuSample> samples, State& state, ImuSample& merged) const;

 private:
  using Vectors = std::array<Eigen::Vector3d, kImus>;

  void learn(std::span<const Eigen::Vector3d> rates, double dt_s, State& state) const;
  void leave_out_hidden(std::span<const ImuSample> samples, const Vectors& forces, const Eigen::Vector3d& rate,
                        double dt_s, State& state, std::array<bool, kImus>& used) const;
  void recover(std::span<const ImuSample> samples, double dt_s, State& state, ImuSample& merged) const;
  static ForceErrors::Params force_params(const Params& params);
  static RateRecovery::Params recovery_params(const Params& params);

  Params params_;
  Eigen::Vector3d p_C_m_ = Eigen::Vector3d::Zero();
  ForceErrors forces_;
  RateRecovery recovery_;
};

}  // namespace tumble
