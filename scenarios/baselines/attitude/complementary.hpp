// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble::baselines {

/// Complementary estimates attitude: the filter integrates the gyro, then rotates the attitude towards the measured
/// vertical (docs/maths/attitude.md, equation (A2)). The correction is the fraction 1 - exp(-dt / tau) of the smallest
/// rotation that aligns the specific force with the vertical, for the sample period dt and the time constant tau. An
/// acceleration that lasts longer than the time constant causes an attitude error. Complementary does not estimate the
/// gyro bias.
class Complementary {
 public:
  struct Params {
    double tau_s = 0.396;  ///< 0.02 per sample at 125 Hz
    double gap_max_s = 1.0;

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.tau_s,
            {"tau_s", "s", 1e-3, 1e4,
             "time constant of the accelerometer correction: 0.02 per sample at 125 Hz (Zevering et al., MFI 2021)",
             ParameterAudience::common_use});
      visit(p.gap_max_s,
            {"gap_max_s", "s", 1e-9, 1e4, "maximum time between two samples; a longer gap causes an error"});
    }
  };
  struct State {
    Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
    TimeNs last_time_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  explicit Complementary(const Params& params);

  /// If the specific force is below 1e-6 m/s^2, Complementary only integrates the gyro.
  Status step(const ImuSample& sample, State& state) const;

 private:
  Params params_;
};

}  // namespace tumble::baselines
