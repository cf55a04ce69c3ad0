// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble::baselines {

/// Madgwick estimates attitude from gyro and accelerometer by Madgwick's gradient filter (Madgwick, internal report,
/// 2010, eqs 25-33). The correction has a constant angular speed, so the estimated attitude oscillates at rest and
/// follows accelerations. Madgwick's filter estimates neither gyro bias nor heading.
class Madgwick {
 public:
  struct Params {
    double gain_rad_s = 0.033;  ///< sqrt(3/4) x gyro error per axis
    double gap_max_s = 1.0;

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.gain_rad_s,
            {"gain_rad_s", "rad/s", 0.0, 10.0, "gain of the tilt correction, as a quaternion rate (Madgwick, eq. 33)",
             ParameterAudience::common_use});
      visit(p.gap_max_s,
            {"gap_max_s", "s", 1e-9, 1e4, "maximum time between two samples; a longer gap causes an error"});
    }
  };
  struct State {
    Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
    TimeNs last_time_ns = 0;
    bool started = false;
    bool operator==(const State& other) const {
      return q_WI.coeffs() == other.q_WI.coeffs() && last_time_ns == other.last_time_ns && started == other.started;
    }
  };

  explicit Madgwick(const Params& params);

  Status step(const ImuSample& sample, State& state) const;

 private:
  Params params_;
};

}  // namespace tumble::baselines
