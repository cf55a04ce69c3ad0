// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/flight_arc.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "tumble/common/so3.hpp"

namespace tumble {

namespace {

/// See flight_arc.md (A6).
Eigen::Vector3d after(const FlyingBody& body, const Eigen::Vector3d& w, double dt) {
  const auto slope = [&](const Eigen::Vector3d& at) { return torque_free_acceleration(body, at); };
  const Eigen::Vector3d k1 = slope(w);
  const Eigen::Vector3d k2 = slope(w + 0.5 * dt * k1);
  const Eigen::Vector3d k3 = slope(w + 0.5 * dt * k2);
  const Eigen::Vector3d k4 = slope(w + dt * k3);
  return w + dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
}

}  // namespace

/// See flight_arc.md (A1).
Eigen::Vector3d torque_free_acceleration(const FlyingBody& body, const Eigen::Vector3d& w) {
  const Eigen::Vector3d momentum = body.inertia_I_kg_m2 * w;
  return body.inertia_I_kg_m2.inverse() * momentum.cross(w);
}

/// See flight_arc.md (A2).
Eigen::Vector3d flight_force(const FlyingBody& body, const Eigen::Vector3d& w, const Eigen::Vector3d& acceleration) {
  return -(acceleration.cross(body.p_IB_I_m) + w.cross(w.cross(body.p_IB_I_m)));
}

Status flight_arc(const FlyingBody& body, const Eigen::Vector3d& start_rad_s, TimeNs from_ns, TimeNs to_ns,
                  TimeNs step_ns, std::vector<MotionSample>& samples) {
  if (to_ns <= from_ns) return {ErrorCode::time_order, "to_ns", double(to_ns), double(from_ns)};
  if (step_ns <= 0) return {ErrorCode::time_order, "step_ns", double(step_ns), 1.0};
  if (!start_rad_s.allFinite() || !body.p_IB_I_m.allFinite() || !body.inertia_I_kg_m2.allFinite()) {
    return {ErrorCode::non_finite, "flying body", std::numeric_limits<double>::quiet_NaN(), 0.0};
  }
  if (Eigen::LLT<Eigen::Matrix3d>(body.inertia_I_kg_m2).info() != Eigen::Success) {
    return {ErrorCode::degenerate, "inertia_I_kg_m2", body.inertia_I_kg_m2.determinant(), 0.0};
  }
  Eigen::Vector3d w = start_rad_s;
  for (TimeNs from = from_ns; from < to_ns;) {
    MotionSample& sample = samples.emplace_back();
    sample.from_ns = from;
    sample.time_ns = std::min(from + step_ns, to_ns);
    const double dt = seconds(sample.time_ns - from);
    const Eigen::Vector3d middle = after(body, w, 0.5 * dt), end = after(body, w, dt);
    sample.w_WI_I_rad_s = (w + 4.0 * middle + end) / 6.0;  // mean rate over the step: flight_arc.md (A7)
    // See flight_arc.md (A9), (A10).
    const Eigen::Vector3d turned = sample.w_WI_I_rad_s * dt;
    const Eigen::Vector3d gained = w.cross(body.p_IB_I_m) - so3::exp(turned) * end.cross(body.p_IB_I_m);
    sample.f_I_m_s2 = so3::left_jacobian_inverse(turned) * gained / dt;
    w = end;
    from = sample.time_ns;
  }
  return {};
}

}  // namespace tumble
