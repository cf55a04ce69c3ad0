// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/attitude/eskf.hpp"
#include "scenarios/methods/attitude_filter.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/settings.hpp"

namespace tumble::scenarios {

namespace {

const Settings<baselines::Eskf::Params>& attitude_eskf_settings() {
  static const Settings<baselines::Eskf::Params> all(baselines::Eskf::Params{}, {.stated = {"gravity_m_s2"}});
  return all;
}

Estimate run_attitude_eskf(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  baselines::Eskf::Params params;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  attitude_eskf_settings().apply(parameters, params);
  // Eskf and AttitudeState define the attitude error equally: in world axes, with q_true = Exp(phi) q.
  return run_attitude_filter<baselines::Eskf>(
      sensors, params,
      [](const baselines::Eskf::State& state) -> Eigen::Matrix3d { return state.covariance.topLeftCorner<3, 3>(); });
}

}  // namespace

Method attitude_eskf() {
  MethodInfo info;
  info.name = "eskf";
  info.kind = Kind::attitude;
  info.doc =
      "Estimates attitude and gyro bias with an error-state Kalman filter, in which the specific force measures the "
      "vertical.";
  info.source = "textbook, J. Sola, Quaternion kinematics for the error-state Kalman filter, arXiv 1711.02508";
  info.settings = {&attitude_eskf_settings()};
  return make_method(std::move(info), run_attitude_eskf);
}

}  // namespace tumble::scenarios
