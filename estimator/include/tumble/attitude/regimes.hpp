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

/// RegimeProbabilities contains the probabilities of one sample's kind of motion (regime). The kinds of motion are free
/// flight (zero specific force at the centre of mass), contact (any force), and hand-held (bounded acceleration about
/// gravity). The three probabilities of RegimeProbabilities sum to 1.
struct RegimeProbabilities {
  double flight = 0.0, contact = 0.0, hand_held = 0.0;
};

/// Estimates the kind of motion (flight, contact or hand-held) of each sample of a recording from the specific force.
///
/// The residual force is e = f - a x r - w x (w x r), the specific force without the effect of rotation at the lever
/// arm. Here f is the specific force, w the rate, a the angular acceleration and r the lever arm. The residual force e
/// is zero in flight. In hand-held motion, e is gravity plus the acceleration of a hand, in any direction. In contact,
/// the residual force e can have any magnitude; the logarithm of the magnitude has a flat density. A Markov chain
/// connects the samples: flight and contact alternate several times per second, but a body is rarely thrown or caught.
/// The Markov chain prevents an impact or a quiet moment of rolling from being mistaken for hand-held motion. Readings
/// within `memory_s` are correlated and count as one reading. Readings without rotation do not change the
/// probabilities.
///
/// RegimeEvidence needs no attitude, so the probabilities are available before HandHeldSmoother runs. RegimeEvidence
/// does not model a body that hangs on a rope, buoyancy, or aerodynamic forces above `flight_m_s2`.
class RegimeEvidence {
 public:
  struct Params {
    double gravity_m_s2 = 9.80665;
    double flight_m_s2 = 0.3;          ///< standard deviation of the residual force in flight: drag, bandwidth
    double flight_share = 0.05;        ///< additional standard deviation, as a fraction of the lever arm's force
    double hand_m_s2 = 5.0;            ///< standard deviation of a hand's acceleration
    double grip_m = 0.05;              ///< distance of the IMU from the hand
    double contact_max_m_s2 = 1000.0;  ///< largest contact force; the smallest contact force is 1 m/s^2
    double memory_s = 0.05;
    double rest_rate_rad_s = 0.5;  ///< readings below this rate do not change the probabilities
    double contacts_hz = 5.0;      ///< rate of changes between flight and contact
    double throws_hz = 0.02;       ///< rate of changes between hand-held motion and flight or contact

    /// Calls the visitor with the value, name, unit, bounds and meaning of every parameter (common/parameters.hpp).
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 1e-300, 100.0, "strength of gravity"});
      visit(
          p.flight_m_s2,
          {"flight_m_s2", "m/s^2", 1e-3, 10.0,
           "standard deviation of the force in flight that the model does not explain, caused by drag and bandwidth"});
      visit(p.flight_share, {"flight_share", "1", 0.0, 1.0,
                             "additional standard deviation of the force in flight, as a share of the force that the "
                             "rotation causes at the lever arm"});
      visit(p.hand_m_s2, {"hand_m_s2", "m/s^2", 0.1, 100.0, "standard deviation of a hand's acceleration"});
      visit(p.grip_m, {"grip_m", "m", 0.0, 1.0, "standard deviation of the distance between hand and IMU"});
      visit(p.contact_max_m_s2,
            {"contact_max_m_s2", "m/s^2", 10.0, 1e6,
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

  /// Computes the probabilities of flight, contact and hand-held motion of each sample. Cost: O(N).
  /// `rates` contains the angular velocity of each sample, from a smoother that assumes flight and contact.
  /// `lever_arm_m` is the vector from the centre of mass to the IMU, in IMU axes.
  /// Returns `ok`, `empty` without samples, or `out_of_range` if `rates` does not have one element per sample.
  Status find(std::span<const ImuSample> samples, std::span<const RateState> rates, const Eigen::Vector3d& lever_arm_m,
              const Eigen::Matrix3d& lever_arm_covariance_m2, std::vector<RegimeProbabilities>& out) const;

  /// Returns the probabilities after one sample, given the probabilities `before`, which are `dt_s` older. Cost: O(1).
  /// `angular_acceleration_rad_s2` is the time derivative of the rate, in IMU axes.
  RegimeProbabilities next(const RegimeProbabilities& before, double dt_s, const ImuSample& sample,
                           const RateState& rate, const Eigen::Vector3d& angular_acceleration_rad_s2,
                           const Eigen::Vector3d& lever_arm_m, const Eigen::Matrix3d& lever_arm_covariance_m2) const;

 private:
  Eigen::Vector3d likelihood(double dt_s, const ImuSample& sample, const RateState& rate, const Eigen::Vector3d& alpha,
                             const Eigen::Vector3d& lever_arm_m, double lever_arm_variance_m2) const;
  Params params_;
};

/// Combines two estimates of a rate, where `share` is the probability that `second` is correct. The result has the mean
/// of the more probable estimate and the covariance of the mixture of both estimates.
RateState mix_rates(const RateState& first, const RateState& second, double share);

}  // namespace tumble
