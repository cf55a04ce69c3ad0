// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>

#include "scenarios/certificate/rows.hpp"
#include "scenarios/certificate/set_up.hpp"

namespace tumble::scenarios {

std::vector<CertificateEntry> certify_free_fall(const CertificateInput& input, const FreeFallSetup& setup) {
  sim::Trial trial(build(input, bare_room("sphere")));
  sim::BodyState start;
  start.p_WB_m.z() = trial.sphere_radius_m() + setup.height_m - trial.p_BG_m().z();
  trial.set_state(start);
  const double expected_s = std::sqrt(2.0 * setup.stated_height_m / trial.gravity_m_s2());
  double touched_s = std::numeric_limits<double>::quiet_NaN();
  while (std::isnan(touched_s) && trial.state().time_s < 10.0 * expected_s + 1.0) {
    trial.step();
    if (!trial.contacts().empty()) touched_s = trial.state().time_s;
  }
  return {{"free_fall_time", "sphere",
           "a fall from height h takes sqrt(2 h / g): time of the first contact minus this time, in steps of the "
           "physics engine",
           "1", (touched_s - expected_s) / trial.step_s(), -0.01, 1.01, ""}};
}

}  // namespace tumble::scenarios
