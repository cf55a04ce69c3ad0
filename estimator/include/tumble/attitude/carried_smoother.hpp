// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rail_detector.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/angular_velocity/rest_detector.hpp"
#include "tumble/attitude/carried_model.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/pose.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// Which elements of an IMU stand at a rail in one sample: -1 the negative one, 1 the positive one, 0 free; of the gyro
/// kVoid where the reading says nothing (one that has wrapped over the rail): neither measurement nor bound.
struct ClipSigns {
  static constexpr std::int8_t kVoid = 2;
  std::array<std::int8_t, 3> gyro{}, accel{};
};
/// Those of a judged sample.
ClipSigns clip_signs(const ImuSample& sample, const Clipping& clipping);

/// What is known of an IMU's rails. Element i senses along row i of `rows` and clips there: where it does, the readings
/// y lie in the plane m_i' y = rail, and truly m_i' (rate + bias) lies beyond.
struct ClippedElements {
  Eigen::Matrix3d rows = Eigen::Matrix3d::Identity();
  std::span<const ClipSigns> signs;  ///< one per sample; empty: nothing clips
};

/// Attitude and angular velocity of a body that is carried (held, swung, twirled), from one IMU, also where its gyro
/// clips: a smoother over a whole recording.
///
/// What a hand does is bounded: its acceleration is short-lived and its velocity and place come back. So the specific
/// force is gravity at the attitude, the lever arm's share and a bounded rest, and gravity turning in the sensor tells
/// the rate that the gyro lost. Nodes at equal times of attitude, rate, angular acceleration and the carried point's
/// acceleration, velocity, place; constants of the device beside them; Gauss-Newton on the arrow matrix (ArrowSystem),
/// covariances from the same factors. O(time) in memory (about 7 kB a node) and work, whatever the IMU's rate.
///
/// Not modelled: flight (a body that is thrown: `hand_surprise` tells), contact beyond what a hand's acceleration
/// explains, walk of the biases, heading.
class CarriedSmoother {
 public:
  struct Params {
    double gravity_m_s2 = 9.80665;      ///< bound (0, 100]
    double node_s = 0.01;               ///< between two nodes; bound [1e-3, 0.1]
    double gyro_noise_density = 5e-4;   ///< rad/s/sqrt(Hz); bound [1e-6, 1]
    double tilt_share = 0.02;           ///< error of a free element per excess of a clipped one; bound [0, 1]
    double rail_sigma_rad_s = 0.01;     ///< how sharp a rail is; bound [1e-4, 1]
    double accel_noise_density = 0.01;  ///< m/s^2/sqrt(Hz); bound [1e-5, 10]
    double accel_error_share = 0.02;    ///< more, per m/s^2 away from gravity; bound [0, 1]
    double jerk_rad_s3_sqrts = 200.0;   ///< root density of the angular jerk; bound [1e-2, 1e6]
    /// What motions of a kind differ in their jerk is not known beforehand: covariances are those of a root density so
    /// many times larger; bound [1, 100].
    double jerk_doubt = 4.0;
    double hand_m_s2 = 5.0;               ///< deviation of the carried point's acceleration; bound [1e-3, 1e3]
    double hand_tau_s = 0.1;              ///< its memory; bound [1e-3, 10]
    double velocity_m_s = 1.0;            ///< deviation of the carried point's velocity; bound [1e-3, 1e3]
    double velocity_tau_s = 0.3;          ///< and memory; bound [1e-3, 1e3]
    double place_m = 1.0;                 ///< deviation of its place; bound [1e-3, 1e3]
    double place_tau_s = 1.0;             ///< and memory of that; bound [1e-3, 1e3]
    double place_leak_s = 10.0;           ///< in which a place is forgotten; bound [0.1, 1e4]
    double gyro_bias_sigma_rad_s = 0.02;  ///< bound (0, 10]
    double accel_bias_sigma_m_s2 = 0.02;  ///< bound (0, 10]
    double turn_error_sqrts = 1e-3;       ///< random walk of the attitude per rad/s turned; bound [0, 1]
    double lever_arm_sigma_m = 0.03;      ///< bound (0, 10]
    int iterations_max = 15;              ///< bound [1, 1000]
    double gap_max_s = 1.0;               ///< bound (0, 1e4]
    double recovered_sigma_rad_s = 1.0;   ///< a clipped rate known better is recovered; bound [0, 1e4]
    double hand_follow = 0.8;        ///< how far the hand's density follows its power about that time; bound [0, 1]
    double hand_window_s = 2.0;      ///< over which that power is taken; bound [0.01, 1e3]
    double hand_floor = 1.0;         ///< least share of the assumed density; bound [1e-3, 1e3]
    double rest_sigma_rad_s = 0.01;  ///< of the rate at rest, one node; bound [1e-6, 10]
    double rest_sigma_m_s = 0.02;    ///< of the velocity at rest; bound [1e-6, 10]
    double rest_sigma_m_s2 = 0.1;    ///< of the acceleration at rest; bound [1e-6, 10]
    RestDetector::Params rest = {};
  };
  struct Report {
    carried::Constants constants;
    carried::System::BorderMatrix constants_covariance = carried::System::BorderMatrix::Zero();
    int iterations = 0;
    bool converged = false;
    double cost = 0.0;
    /// Largest mean acceleration of the carried point over a quarter of a second, in deviations of what is assumed. One
    /// that is thrown (specific force about 0) shows 2 and more; so does a hand that is rough: it warns, it decides
    /// nothing.
    double hand_surprise = 0.0;
    /// Clipped stretches in which the body may have turned once more, or less, than the descent says: how many were
    /// long and unknown enough to be asked, in how many another number of turns was the better one and was taken (a
    /// stretch counts anew in each round), and in how many others stay possible, at odds of 1 to 1000 or better: there
    /// the covariance holds their spread.
    int turns_asked = 0, turns_taken = 0, turns_open = 0;
  };

  /// Throws InvalidParams when a parameter is outside of its bound.
  explicit CarriedSmoother(const Params& params);

  /// One rate and one attitude per sample (sensor axes to world, heading 0 at the start). Trouble: `empty`,
  /// `non_finite`, `time_order`, `gap` as for a filter; `out_of_range` for signs that are not one per sample;
  /// `diverged` when the equations lose their definiteness. The outputs are then empty.
  Status estimate(std::span<const ImuSample> samples, const ClippedElements& clipped, std::vector<RateState>& rates,
                  std::vector<AttitudeState>& attitudes, Report& report) const;

 private:
  Params params_;
};

}  // namespace tumble
