// SPDX-License-Identifier: BSD-3-Clause
#include "rate_stream_impl.hpp"

namespace tumble {

SensorHealth AngularRateStream::health(const State& state) const {
  SensorHealth out;
  impl_->frozen_axes.add_findings(HealthFinding::Kind::frozen_axis, "imu", state.frozen_axes, out);
  out.add(HealthFinding::Kind::inverted_accel_in_flight,
          impl_->flight_axis_sign_check.current_verdict(state.flight_sign_check), "imu");
  return out;
}

}  // namespace tumble
