// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/angular_velocity/quantile.hpp"
#include "estimator/attitude/hand_held_motion.hpp"
#include "tests/testing.hpp"

/// hand_held_errors.hpp computes errors of the rates of a hand-held body against its motion in closed form.
namespace tumble::testing {

/// Returns the norms of the errors at clipped samples from `from_s` on; there is one rate per sample, at its stamp
/// [rad/s].
inline std::vector<double> clipped_errors(const HandHeldRecording& recording,
                                          const std::vector<AngularRateState>& rates, double from_s) {
  std::vector<double> out;
  for (std::size_t k = 0; k < rates.size(); ++k) {
    EXPECT_EQ(rates[k].time_ns, recording.samples[k].time_ns);
    if (recording.signs[k].gyro[0] == 0 || seconds(rates[k].time_ns) < from_s) continue;
    out.push_back((rates[k].w_WI_I_rad_s - recording.rate_rad_s[k]).norm());
  }
  return out;
}

}  // namespace tumble::testing
