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

/// Probabilities, of one sample, of what a body is doing: free of support (the specific force at the centre of mass is
/// zero), touching something (a force of any size), held by a hand (a bounded acceleration about gravity); their sum is
/// 1.
struct RegimeShares {
  double flight = 0.0, contact = 0.0, carried = 0.0;
};

/// Which regime each sample of a recording is in, by its specific force: what is left of it after the turning at the
/// lever arm, e = f - a x r - w x (w x r), is zero in flight, the size of gravity and a hand's acceleration when the
/// body is carried, whatever its direction, and anything (a norm flat in its logarithm) in contact. A Markov chain over
/// the samples joins them: flight and contact follow each other several times a second, but a body is rarely thrown or
/// caught, so that an impact does not pass for a hand, nor a quiet moment of a roll. Readings within `memory_s` are not
/// independent and count as one. A body that does not turn says nothing of who holds it.
///
/// Needs no attitude, so that it is decided before the problem of the carried body is posed. Not modelled: a body that
/// hangs on a rope, buoyancy, forces of air beyond `flight_m_s2`.
class RegimeEvidence {
 public:
  struct Params {
    double gravity_m_s2 = 9.80665;
    double flight_m_s2 = 0.3;          ///< deviation of the force left in flight: drag, bandwidth
    double flight_share = 0.05;        ///< more, as a share of the lever arm's force
    double hand_m_s2 = 5.0;            ///< deviation of a hand's acceleration
    double grip_m = 0.05;              ///< how far from the hand an IMU is
    double contact_max_m_s2 = 1000.0;  ///< forces of contact lie between 1 m/s^2 and this
    double memory_s = 0.05;
    double rest_rate_rad_s = 0.5;  ///< slower turning says nothing of who holds the body
    double contacts_hz = 5.0;      ///< changes between flight and contact
    double throws_hz = 0.02;       ///< changes between these and a hand

    /// Every number of it, stated once.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 1e-300, 100.0, "strength of gravity"});
      visit(p.flight_m_s2, {"flight_m_s2", "m/s^2", 1e-3, 10.0,
                            "standard deviation of the residual force in flight: drag, bandwidth"});
      visit(p.flight_share,
            {"flight_share", "1", 0.0, 1.0,
             "standard deviation of the residual force in flight, as a share of the lever arm's force"});
      visit(p.hand_m_s2, {"hand_m_s2", "m/s^2", 0.1, 100.0, "standard deviation of a hand's acceleration"});
      visit(p.grip_m, {"grip_m", "m", 0.0, 1.0, "standard deviation of the distance between hand and IMU"});
      visit(p.contact_max_m_s2, {"contact_max_m_s2", "m/s^2", 10.0, 1e6,
                                 "largest contact force; contact forces are between 1 m/s^2 and this"});
      visit(p.memory_s, {"memory_s", "s", 1e-3, 10.0, "readings within this time count as one observation"});
      visit(p.rest_rate_rad_s, {"rest_rate_rad_s", "rad/s", 0.0, 100.0, "least rate at which the regime is estimated"});
      visit(p.contacts_hz, {"contacts_hz", "Hz", 1e-3, 100.0, "rate of changes between flight and contact"});
      visit(p.throws_hz, {"throws_hz", "Hz", 1e-9, 10.0, "rate of changes between hand-held and free motion"});
    }
  };

  /// Throws InvalidParams when a parameter is outside of its bound.
  explicit RegimeEvidence(const Params& params);

  /// One RegimeShares per sample. `rates` are those of a smoother that believes in flight and contact, one per sample;
  /// `lever_arm_m` from the centre of mass to the IMU, its axes, with its covariance. Trouble: `empty`; `out_of_range`
  /// for rates that are not one per sample. O(N).
  Status find(std::span<const ImuSample> samples, std::span<const RateState> rates, const Eigen::Vector3d& lever_arm_m,
              const Eigen::Matrix3d& lever_arm_covariance_m2, std::vector<RegimeShares>& out) const;

  /// The same as a filter: the shares after a sample, given those after the one `dt_s` before it, with the rate's
  /// derivative. O(1).
  RegimeShares next(const RegimeShares& before, double dt_s, const ImuSample& sample, const RateState& rate,
                    const Eigen::Vector3d& angular_acceleration_rad_s2, const Eigen::Vector3d& lever_arm_m,
                    const Eigen::Matrix3d& lever_arm_covariance_m2) const;

 private:
  Eigen::Vector3d likelihood(double dt_s, const ImuSample& sample, const RateState& rate, const Eigen::Vector3d& alpha,
                             const Eigen::Vector3d& lever_arm_m, double lever_arm_variance_m2) const;
  Params params_;
};

/// A rate of which two smoothers say different things: that of the likelier one with the covariance of both, the spread
/// between them included. `share`: probability of `second`.
RateState either(const RateState& first, const RateState& second, double share);

}  // namespace tumble
