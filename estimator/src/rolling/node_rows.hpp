// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "rolling_node.hpp"

/// The functions in this file call `take(row, measured, variance)` for each scalar measurement of the error state x:
/// measured = row * x + noise. `row` is a Row, or the index of a single state. Each call of `take` may change the state
/// `x` and its covariance `P`.
namespace tumble::rolling {

/// During grip, the contact point is at rest. During slip, the contact point moves along the floor: rolling.md (R17),
/// (R20). If the velocity of the sphere is very uncertain, a weak pseudo-measurement of zero velocity is added.
template <class EstimateCallback>
void contact_measurement_rows(const Contact& c, ContactMode mode, double node_s, const Eigen::Vector3d& v_WI_m_s,
                              const Vector& x, const Covariance& P, EstimateCallback&& take) {
  // The contact velocity is not linear in the error state. The nonlinear part of the contact velocity is subtracted
  // from the measurement.
  const Eigen::Vector3d u = c.velocity(x) - c.measurement_jacobian * x, variance = contact_variance(c, mode);
  if (!may_slip(mode)) {
    for (int axis = 0; axis < 2; ++axis) take(Row(c.measurement_jacobian.row(axis)), -u[axis], variance[axis]);
  }
  if (mode != ContactMode::bump_or_flight) take(Row(c.measurement_jacobian.row(2)), -u.z(), variance.z());
  if (const auto lost = velocity_variance_if_lost(node_s, P)) {
    for (int axis = 0; axis < 2; ++axis) take(kVelocity + axis, -v_WI_m_s[axis], *lost);
  }
}

/// See rolling.md (R28).
template <class EstimateCallback>
void stationary_measurement_rows(const RollingNodeIntegrals& sums, const RollingNominalState& nominal,
                                 bool spins_in_place, EstimateCallback&& take) {
  for (int axis = 0; axis < 3; ++axis) {
    take(kVelocity + axis, -nominal.v_WI_m_s[axis], squared(RollingContactParams::kRestVelocitySigma_m_s));
    if (spins_in_place) continue;
    const double bias_rad_s = sums.rate_integral_I_rad[axis] / sums.node_interval_s;
    take(kGyroBias + axis, bias_rad_s, squared(RollingContactParams::kRestRateSigma_rad_s));
  }
}

}  // namespace tumble::rolling
