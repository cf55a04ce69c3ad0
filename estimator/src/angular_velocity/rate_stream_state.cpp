// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/rate_stream.hpp"

namespace tumble {

SensorHealth AngularRateStream::health(const State& state) const {
  SensorHealth out;
  frozen_axes_.add_findings(HealthFinding::Kind::frozen_axis, "imu", state.frozen_axes, out);
  out.add(HealthFinding::Kind::inverted_accel_in_flight,
          flight_axis_sign_check_.current_verdict(state.flight_sign_check), "imu");
  return out;
}

}  // namespace tumble
