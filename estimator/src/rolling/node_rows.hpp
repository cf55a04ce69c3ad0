// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "rolling_node.hpp"

/// What a node tells of the error state, row by row: the filter's hypotheses update by them, the smoother keeps them
/// too. `take(row, measured, variance)` takes one: measurement = row x + noise, `row` being a Row or the index of the
/// one state that it picks. It is called in order, and may move `x` and `P` on which the next row is asked.
namespace tumble::rolling {

/// A contact point stands still (or, slipping, stays on the floor), and a velocity that is lost is no great one:
/// rolling.md (R16), (R19).
template <class Take>
void contact_rows(const RollingParams& params, const Contact& c, RollingMode mode, double node_s,
                  const Eigen::Vector3d& v_WI_m_s, const Vector& x, const Covariance& P, Take&& take) {
  // what the length of the normal adds is no error of the state
  const Eigen::Vector3d u = c.velocity(x) - c.H * x, variance = contact_variance(params, c, mode);
  if (!slips(mode)) {
    for (int axis = 0; axis < 2; ++axis) take(Row(c.H.row(axis)), -u[axis], variance[axis]);
  }
  if (mode != RollingMode::bump) take(Row(c.H.row(2)), -u.z(), variance.z());
  if (const auto lost = lost_velocity_variance(params, node_s, P)) {
    for (int axis = 0; axis < 2; ++axis) take(kVelocity + axis, -v_WI_m_s[axis], *lost);
  }
}

/// It stands still: velocity and, unless it spins in place, rate are zero. rolling.md (R27).
template <class Take>
void rest_rows(const RollingParams& params, const RollingSums& sums, const RollingNominal& nominal, bool spins_in_place,
               Take&& take) {
  for (int axis = 0; axis < 3; ++axis) {
    take(kVelocity + axis, -nominal.v_WI_m_s[axis], squared(params.expert.contact.rest_velocity_sigma_m_s));
    if (spins_in_place) continue;
    const double bias_rad_s = sums.w_I_rad[axis] / sums.node_s;  // already without the nominal bias
    take(kGyroBias + axis, bias_rad_s, squared(params.expert.contact.rest_rate_sigma_rad_s));
  }
}

}  // namespace tumble::rolling
