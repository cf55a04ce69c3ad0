// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "scenarios/certificate/rows.hpp"
#include "scenarios/certificate/set_up.hpp"
#include "sim/imu/imu_simulation.hpp"

namespace tumble::scenarios {

std::vector<CertificateEntry> certify_flight_force(const CertificateInput& input, const FlightForceSetup& setup) {
  sim::Trial trial(build(input, bare_room("rig")));
  trial.set_state(thrown(setup.rate_rad_s));
  const sim::Truth truth = fly(trial, setup.duration_s);

  sim::SensorSpec ideal;
  ideal.name = "imu";
  ideal.kind = "imu";
  ideal.values.set("output_rate_hz", 1.0 / trial.step_s());
  ideal.values = sim::resolve("certificate.imu", ideal.values, sim::imu_parameters());
  Eigen::Isometry3d T_BI = Eigen::Isometry3d::Identity();
  T_BI.translation().x() = setup.lever_arm_m;
  sim::ImuRecord record;
  sim::ImuTruth imu_truth;
  sim::simulate_imu(truth, ideal, T_BI, trial.gravity_m_s2(), 1, record, imu_truth);

  double largest_m_s2 = 0.0;
  for (const Eigen::Vector3d& f : record.accel_m_s2) largest_m_s2 = larger(largest_m_s2, f.norm());
  return {{"flight_specific_force", "rig",
           "an ideal accelerometer at the centre of mass reads zero in free flight: maximum reading", "m/s^2",
           largest_m_s2, 0.0, 1e-6, ""}};
}

}  // namespace tumble::scenarios
