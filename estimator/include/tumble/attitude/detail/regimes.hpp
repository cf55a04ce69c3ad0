// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// RegimeProbabilities contains the probabilities of three kinds of motion at one sample, which sum to 1. Free flight
/// has zero specific force at the centre of mass, contact has any force, and hand-held motion has a bounded
/// acceleration about gravity.
struct RegimeProbabilities {
  double flight = 0.0, contact = 0.0, hand_held = 0.0;
};

/// Estimates the kind of motion (flight, contact or hand-held) of each sample of a recording from the specific force.
///
/// The residual force is e = f - a x r - w x (w x r), the specific force without the effect of rotation at the lever
/// arm. The symbols are the specific force f, the rate w, the angular acceleration a and the lever arm r. The residual
/// force e is zero in flight. In hand-held motion, the residual force is gravity plus the acceleration of a hand, in
/// any direction. In contact, the residual force can have any magnitude; the logarithm of the magnitude has a uniform
/// prior. A Markov chain connects the samples: flight and contact alternate several times per second, but a body is
/// rarely thrown or caught. The Markov chain prevents RegimeEvidence from mistaking an impact or a quiet moment of
/// rolling for hand-held motion. Readings within `memory_s` are correlated and count as one reading. Readings without
/// rotation do not change the probabilities.
///
/// RegimeEvidence does not use the attitude, so its probabilities are available before HandHeldSmoother runs.
/// RegimeEvidence assumes that no rope, no buoyancy and no aerodynamic force above `flight_force_sigma_m_s2` acts on
/// the body.
class RegimeEvidence {
 public:
  struct Params {
    double gravity_m_s2 = 9.80665;
    double flight_force_sigma_m_s2 = 0.3;    ///< standard deviation of the residual force in flight
    double flight_share = 0.05;              ///< additional standard deviation / force a x r + w x (w x r)
    double hand_sigma_m_s2 = 5.0;            ///< standard deviation of a hand's acceleration
    double hand_distance_m = 0.05;           ///< distance of the IMU from the hand
    double contact_force_max_m_s2 = 1000.0;  ///< largest contact force; the smallest contact force is 1 m/s^2
    double memory_s = 0.05;
    double rest_rate_rad_s = 0.5;  ///< readings with a lower rate do not change the probabilities
    double contacts_hz = 5.0;      ///< mean number of changes between flight and contact per second
    double throws_hz = 0.02;       ///< mean number of throws and catches per second

    /// Calls `visit` once for each parameter, with its value, name, unit, bounds and meaning.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 1e-300, 100.0, "strength of gravity"});
      visit(
          p.flight_force_sigma_m_s2,
          {"flight_force_sigma_m_s2", "m/s^2", 1e-3, 10.0,
           "standard deviation of the force in flight that the model does not explain, caused by drag and bandwidth"});
      visit(p.flight_share, {"flight_share", "1", 0.0, 1.0,
                             "additional standard deviation of the force in flight, as a share of the force that the "
                             "rotation causes at the lever arm"});
      visit(p.hand_sigma_m_s2, {"hand_sigma_m_s2", "m/s^2", 0.1, 100.0, "standard deviation of a hand's acceleration"});
      visit(p.hand_distance_m,
            {"hand_distance_m", "m", 0.0, 1.0, "standard deviation of the distance between hand and IMU"});
      visit(p.contact_force_max_m_s2,
            {"contact_force_max_m_s2", "m/s^2", 10.0, 1e6,
             "maximum contact force; the model assumes contact forces between 1 m/s^2 and this value"});
      visit(p.memory_s,
            {"memory_s", "s", 1e-3, 10.0, "time within which readings count as one independent observation"});
      visit(p.rest_rate_rad_s, {"rest_rate_rad_s", "rad/s", 0.0, 100.0,
                                "minimum rate for an estimate of the regime (flight, contact or hand-held)"});
      visit(p.contacts_hz,
            {"contacts_hz", "Hz", 1e-3, 100.0, "assumed frequency of changes between flight and contact"});
      visit(p.throws_hz,
            {"throws_hz", "Hz", 1e-9, 10.0, "assumed frequency of changes between hand-held and free motion"});
    }
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit RegimeEvidence(const Params& params);

  /// Estimates the probabilities of flight, contact and hand-held motion of each sample. Cost: O(N). The argument
  /// `rates` contains the angular velocity of each sample, from a smoother that assumes flight and contact. The
  /// argument `lever_arm_m` is the vector from the centre of mass to the IMU, in IMU axes. Returns `ok`, `empty` if
  /// there are no samples, or `out_of_range` if `rates` does not have one element per sample.
  Status find(std::span<const ImuSample> samples, std::span<const RateState> rates, const Eigen::Vector3d& lever_arm_m,
              const Eigen::Matrix3d& lever_arm_covariance_m2, std::vector<RegimeProbabilities>& out) const;

  /// Returns the probabilities after one sample, given the probabilities `before`, which are `dt_s` older. Cost: O(1).
  /// The argument `angular_acceleration_rad_s2` is the time derivative of the rate, in IMU axes.
  RegimeProbabilities next(const RegimeProbabilities& before, double dt_s, const ImuSample& sample,
                           const RateState& rate, const Eigen::Vector3d& angular_acceleration_rad_s2,
                           const Eigen::Vector3d& lever_arm_m, const Eigen::Matrix3d& lever_arm_covariance_m2) const;

 private:
  Eigen::Vector3d likelihood(double dt_s, const ImuSample& sample, const RateState& rate, const Eigen::Vector3d& alpha,
                             const Eigen::Vector3d& lever_arm_m, double lever_arm_variance_m2) const;
  Params params_;
};

/// Combines two estimates of a rate, where `share` is the probability that `second` is correct. The combined rate has
/// the mean of the more probable estimate and the covariance of the mixture of both estimates.
RateState mix_rate_states(const RateState& first, const RateState& second, double share);

}  // namespace tumble
