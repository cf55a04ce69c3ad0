// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "tumble/angular_velocity/types.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Probabilities of free flight, contact and hand-held motion at one sample, with the sum 1.
struct RegimeProbabilities {
  double flight = 0.0, contact = 0.0, hand_held = 0.0;
};

/// Estimates the kind of motion (free flight, contact or hand-held) of each sample of a recording from the specific
/// force.
///
/// The residual force is the specific force minus centripetal and tangential force at the lever arm. The residual force
/// is zero in free flight, and has any magnitude in contact. In hand-held motion, the residual force is gravity plus a
/// bounded acceleration. A Markov chain models the transitions between the kinds of motion. Readings within kMemory_s
/// count as one independent observation.
///
/// MotionRegimeEvidence does not use the attitude, and does not model ropes, buoyancy, and aerodynamic forces above 0.3
/// m/s^2.
class MotionRegimeEvidence {
 public:
  static constexpr double kMemory_s = 0.05;
  struct Params {
    double gravity_m_s2 = 9.80665;

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 1e-300, 100.0, "strength of gravity"});
    }
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit MotionRegimeEvidence(const Params& params);

  /// Estimates the probabilities at all samples. `rates` contains the angular velocity at each sample, estimated for
  /// flight and contact. `lever_arm_m` is the vector from the centre of mass to the IMU, in IMU axes. Returns `ok`,
  /// `empty` if there are no samples, or `out_of_range` if `rates` does not have one element per sample. Cost: O(N).
  Status find(std::span<const ImuSample> samples, std::span<const AngularRateState> rates,
              const Eigen::Vector3d& lever_arm_m, const Eigen::Matrix3d& lever_arm_covariance_m2,
              std::vector<RegimeProbabilities>& out) const;

  /// Returns the probabilities at `sample`, from the probabilities `before` at the time `dt_s` earlier.
  /// `angular_acceleration_rad_s2` is the time derivative of the rate, in IMU axes. Cost: O(1).
  RegimeProbabilities next(const RegimeProbabilities& before, double dt_s, const ImuSample& sample,
                           const AngularRateState& rate, const Eigen::Vector3d& angular_acceleration_rad_s2,
                           const Eigen::Vector3d& lever_arm_m, const Eigen::Matrix3d& lever_arm_covariance_m2) const;

 private:
  Eigen::Vector3d likelihood(double dt_s, const ImuSample& sample, const AngularRateState& rate,
                             const Eigen::Vector3d& alpha, const Eigen::Vector3d& lever_arm_m,
                             double lever_arm_variance_m2) const;
  Params params_;
};

/// Combines two estimates of a rate, where `share` is the probability that `second` is correct. The result has the rate
/// of the more probable estimate, and a covariance that includes the difference between both estimates.
AngularRateState mix_rate_states(const AngularRateState& first, const AngularRateState& second, double share);

}  // namespace tumble
