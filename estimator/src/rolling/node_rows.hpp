// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "rolling_node.hpp"

/// node_rows.hpp computes the scalar measurements of a node, for the filter and for the smoother. `take(row, measured,
/// variance)` processes one measurement: measured = row x + noise. `row` is a Row, or the index of a single state. A
/// call of `take` may change the state `x` and its covariance `P`, which the next measurement uses.
namespace tumble::rolling {

/// Applies the rolling constraint, see rolling.md (R17), (R20): the contact point is at rest, or moves along the floor
/// during slip. An unknown velocity is assumed to be small.
template <class EstimateCallback>
void contact_rows(const RollingParams& params, const Contact& c, RollingMode mode, double node_s,
                  const Eigen::Vector3d& v_WI_m_s, const Vector& x, const Covariance& P, EstimateCallback&& take) {
  // The nonlinear part of the contact velocity is not an error of the state, so it is subtracted.
  const Eigen::Vector3d u = c.velocity(x) - c.H * x, variance = contact_variance(params, c, mode);
  if (!may_slip(mode)) {
    for (int axis = 0; axis < 2; ++axis) take(Row(c.H.row(axis)), -u[axis], variance[axis]);
  }
  if (mode != RollingMode::bump) take(Row(c.H.row(2)), -u.z(), variance.z());
  if (const auto lost = lost_velocity_variance(node_s, P)) {
    for (int axis = 0; axis < 2; ++axis) take(kVelocity + axis, -v_WI_m_s[axis], *lost);
  }
}

/// Applies the measurements of a sphere at rest, see rolling.md (R28). The velocity is zero. The rate is zero unless
/// the sphere spins in place.
template <class EstimateCallback>
void rest_rows(const RollingParams& params, const RollingIntegrals& sums, const RollingNominal& nominal,
               bool spins_in_place, EstimateCallback&& take) {
  for (int axis = 0; axis < 3; ++axis) {
    take(kVelocity + axis, -nominal.v_WI_m_s[axis], squared(params.expert.contact.rest_velocity_sigma_m_s));
    if (spins_in_place) continue;
    // Mean rate, without the subtraction of the nominal bias.
    const double bias_rad_s = sums.rate_integral_I_rad[axis] / sums.node_s;
    take(kGyroBias + axis, bias_rad_s, squared(params.expert.contact.rest_rate_sigma_rad_s));
  }
}

}  // namespace tumble::rolling
