// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/rate_stream.hpp"

namespace tumble {

SensorHealth RateStream::health(const State& state) const {
  SensorHealth out;
  frozen_.add_findings(HealthFinding::Kind::frozen_axis, "imu", state.frozen, out);
  out.add(HealthFinding::Kind::flight_forces, flight_sign_check_.current_verdict(state.sense), "imu");
  return out;
}

}  // namespace tumble
