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
#include "tumble/attitude/detail/carried_model.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
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
  /// One per sample: covariance of a rate that no gyro read but somebody recovered from what this smoother does not
  /// know (flight), sensor axes; zero: as read. Empty: all are. No element of a recovered sample is called clipped.
  std::span<const Eigen::Matrix3d> recovered_rad2_s2 = {};
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
    double gravity_m_s2 = 9.80665;
    double node_s = 0.01;               ///< between two nodes
    double gyro_noise_density = 5e-4;   ///< rad/s/sqrt(Hz)
    double tilt_share = 0.02;           ///< error of a free element per excess of a clipped one
    double rail_sigma_rad_s = 0.01;     ///< how sharp a rail is
    double accel_noise_density = 0.01;  ///< m/s^2/sqrt(Hz)
    double accel_error_share = 0.02;    ///< more, per m/s^2 away from gravity
    double jerk_rad_s3_sqrts = 200.0;   ///< root density of the angular jerk
    /// What motions of a kind differ in their jerk is not known beforehand: covariances are those of a root density so
    /// many times larger.
    double jerk_doubt = 4.0;
    double hand_m_s2 = 5.0;       ///< deviation of the carried point's acceleration
    double hand_tau_s = 0.1;      ///< its memory
    double velocity_m_s = 1.0;    ///< deviation of the carried point's velocity
    double velocity_tau_s = 0.3;  ///< and memory
    double place_m = 1.0;         ///< deviation of its place
    double place_tau_s = 1.0;     ///< and memory of that
    double place_leak_s = 10.0;   ///< in which a place is forgotten
    double gyro_bias_sigma_rad_s = 0.02;
    double accel_bias_sigma_m_s2 = 0.02;
    double turn_error_sqrts = 1e-3;  ///< random walk of the attitude per rad/s turned
    double lever_arm_sigma_m = 0.03;
    int iterations_max = 15;
    double gap_max_s = 1.0;
    double recovered_sigma_rad_s = 1.0;  ///< a clipped rate known better is recovered
    double hand_follow = 0.8;            ///< how far the hand's density follows its power about that time
    double hand_window_s = 2.0;          ///< over which that power is taken
    double hand_floor = 1.0;             ///< least share of the assumed density
    double recovered_tau_s = 0.005;      ///< memory of the error of a rate that was recovered
    double rest_sigma_rad_s = 0.01;      ///< of the rate at rest, one node
    double rest_sigma_m_s = 0.02;        ///< of the velocity at rest
    double rest_sigma_m_s2 = 0.1;        ///< of the acceleration at rest
    RestDetector::Params rest = {};

    /// Every number of it, stated once.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 1e-300, 100.0, "strength of gravity"});
      visit(p.node_s, {"node_s", "s", 1e-3, 0.1, "between two nodes of the smoother", Rank::first});
      visit(p.gyro_noise_density, {"gyro_noise_density", "rad/s/sqrt(Hz)", 1e-6, 1.0, "noise density of the gyro"});
      visit(p.tilt_share,
            {"tilt_share", "1", 0.0, 1.0, "error of a free element per excess of a clipped one", Rank::first});
      visit(p.rail_sigma_rad_s, {"rail_sigma_rad_s", "rad/s", 1e-4, 1.0, "how sharp a rail is"});
      visit(p.accel_noise_density, {"accel_noise_m_s2_sqrt_hz", "m/s^2/sqrt(Hz)", 1e-5, 10.0,
                                    "noise density of the specific force, unmodelled errors included", Rank::first});
      visit(p.accel_error_share,
            {"accel_error_share", "1", 0.0, 1.0, "noise of the specific force more, per m/s^2 away from gravity"});
      visit(p.jerk_rad_s3_sqrts,
            {"jerk_rad_s3_sqrts", "rad/s^3 sqrt(s)", 1e-2, 1e6, "root density of the angular jerk", Rank::first});
      visit(p.jerk_doubt, {"jerk_doubt", "1", 1.0, 100.0,
                           "covariances are those of a root density of the jerk so many times larger", Rank::first});
      visit(p.hand_m_s2,
            {"hand_m_s2", "m/s^2", 1e-3, 1e3, "deviation of the carried point's acceleration", Rank::first});
      visit(p.hand_tau_s, {"hand_tau_s", "s", 1e-3, 10.0, "memory of the carried point's acceleration", Rank::first});
      visit(p.velocity_m_s,
            {"velocity_m_s", "m/s", 1e-3, 1e3, "deviation of the carried point's velocity", Rank::first});
      visit(p.velocity_tau_s, {"velocity_tau_s", "s", 1e-3, 1e3, "memory of the carried point's velocity"});
      visit(p.place_m, {"place_m", "m", 1e-3, 1e3, "deviation of the carried point's place", Rank::first});
      visit(p.place_tau_s, {"place_tau_s", "s", 1e-3, 1e3, "memory of the carried point's place"});
      visit(p.place_leak_s, {"place_leak_s", "s", 0.1, 1e4, "in which a place is forgotten"});
      visit(p.gyro_bias_sigma_rad_s,
            {"gyro_bias_sigma_rad_s", "rad/s", 1e-6, 10.0, "prior of the gyro's bias", Rank::first});
      visit(p.accel_bias_sigma_m_s2,
            {"accel_bias_sigma_m_s2", "m/s^2", 1e-6, 10.0, "prior of the accelerometer's bias", Rank::first});
      visit(p.turn_error_sqrts,
            {"turn_error_sqrts", "sqrt(s)", 0.0, 1.0, "angle random walk per rad/s turned: scale", Rank::first});
      visit(p.lever_arm_sigma_m,
            {"lever_arm_sigma_m", "m", 1e-6, 10.0, "prior of the way from the carried point", Rank::first});
      visit(p.iterations_max, {"iterations_max", "1", 1, 1000, "most steps of Gauss-Newton", Rank::first});
      visit(p.gap_max_s, {"gap_max_s", "s", 1e-300, 1e4, "longest time between two samples before the run is refused"});
      visit(p.recovered_sigma_rad_s,
            {"recovered_sigma_rad_s", "rad/s", 0.0, 1e4,
             "a clipped rate known better than this is recovered, not only bounded", Rank::first});
      visit(p.hand_follow,
            {"hand_follow", "1", 0.0, 1.0, "how far the hand's density follows the motion's own power", Rank::first});
      visit(p.hand_window_s, {"hand_window_s", "s", 0.01, 1e3, "over which that power is taken"});
      visit(p.hand_floor, {"hand_floor", "1", 1e-3, 1e3, "least share of the hand's assumed density"});
      visit(p.recovered_tau_s, {"recovered_tau_s", "s", 1e-4, 1e4, "memory of the error of a rate that was recovered"});
      visit(p.rest_sigma_rad_s, {"rest_sigma_rad_s", "rad/s", 1e-6, 10.0, "of the rate at rest, one node"});
      visit(p.rest_sigma_m_s, {"rest_sigma_m_s", "m/s", 1e-6, 10.0, "of the velocity at rest"});
      visit(p.rest_sigma_m_s2, {"rest_sigma_m_s2", "m/s^2", 1e-6, 10.0, "of the acceleration at rest"});
      visit.group("rest_", p.rest);
    }
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
    /// Turns that were to be taken and from which the whole could not be solved: the answer without them stands, and
    /// they count as possible.
    int turns_failed = 0;
  };

  /// Throws InvalidParams when a parameter is outside of its bound.
  explicit CarriedSmoother(const Params& params);

  /// One rate and one attitude per sample (sensor axes to world, heading 0 at the start). Trouble: `empty`,
  /// `non_finite`, `time_order`, `gap` as for a filter; `out_of_range` for signs or recovered rates that are not one
  /// per sample, or for a covariance of these that is none; `diverged` when the equations lose their definiteness. The
  /// outputs are then empty.
  Status estimate(std::span<const ImuSample> samples, const ClippedElements& clipped, std::vector<RateState>& rates,
                  std::vector<AttitudeState>& attitudes, Report& report) const;

 private:
  Params params_;
};

}  // namespace tumble
