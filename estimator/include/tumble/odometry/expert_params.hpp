// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

#include "tumble/attitude/detail/regime_stream.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/sample_clock.hpp"
#include "tumble/mapping/detail/odometry_params.hpp"
#include "tumble/odometry/rolling_odometry.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"
#include "tumble/rolling/detail/rolling_smoother.hpp"

namespace tumble {

/// Parameters for processing the first seconds of motion a second time, with the calibration estimated so far; see
/// TumblingOdometry.
struct FirstSecondsReprocessingParams {
  double after_motion_s = 3.0;      ///< duration of motion after which the reprocessing starts; 0: never
  double tracking_failure_s = 0.4;  ///< duration of a tracking failure that starts the reprocessing early; 0: never
  double rate_lag_s = 0.5;          ///< lag with which the reprocessing smooths the angular velocity

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.after_motion_s, {"after_s", "s", 0.0, 100.0,
                             "after this time in motion, a second pass processes all data again with the estimated "
                             "calibration; 0: no second pass"});
    visit(p.tracking_failure_s,
          {"lost_s", "s", 0.0, 100.0,
           "time without a registered sweep after which the second pass starts early, once; 0: no early start"});
    visit(p.rate_lag_s, {"lag_s", "s", 0.0, 10.0, "second pass: age of a sample when its rate is reported"});
  }
};

/// Rarely changed parameters of TumblingOdometry. If a parameter is in both this struct and TumblingParams,
/// TumblingOdometry uses the value in TumblingParams.
struct TumblingExpertParams {
  double gravity_m_s2 = 9.80665;
  /// Maximum number of sweeps that wait for IMU samples, in addition to the sweeps of the last `lag_s`. If more than
  /// `waiting_sweeps_max` registered sweeps wait for take(), TumblingOdometry drops the oldest sweep.
  std::size_t waiting_sweeps_max = 16;
  /// Parameters of the estimation of angular velocity. By default, the prior probability that the IMU does not match
  /// its data sheet is 0.003. The covariance of each estimated rate includes the uncertainty of the IMU's calibration.
  MotionRegimeStream::Params rate = default_rate_params();
  /// Parameters of the mapping. By default, the direction of gravity and the errors of rates on clipped gyro axes are
  /// unknowns of the registration.
  OdometryParams mapping = default_mapping_params();
  /// Parameters of the correction of IMU time stamps that a host computer assigned.
  SampleClock::Params stamps;
  FirstSecondsReprocessingParams first_seconds_reprocessing;
  static OdometryParams default_mapping_params();
  static MotionRegimeStream::Params default_rate_params();
  /// Returns the names of parameters that TumblingOdometry computes from other parameters. A name that ends in '*'
  /// stands for all names that start with the text before the '*'. TumblingOdometry ignores values that a user sets for
  /// computed parameters.
  static std::span<const char* const> computed_parameter_names();

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 0.0, 100.0, "strength of gravity", ParameterAudience::common_use});
    visit(p.waiting_sweeps_max, {"sweeps_max", "1", 1, 1e6, "maximum number of sweeps that wait for IMU data"});
    visit.group("rate_", p.rate);
    visit.group("mapping_", p.mapping);
    visit.group("stamps_", p.stamps);
    visit.group("second_pass_", p.first_seconds_reprocessing);
  }
};

struct MergedRecordings;

/// Rarely changed parameters of RollingOdometry. If a parameter is in both this struct and
/// RollingOdometry::Params, RollingOdometry uses the value in RollingOdometry::Params.
struct RollingOdometryExpertParams {
  RollingSmoother::Params rolling;
  SampleClock::Params stamps;  ///< correction of time stamps that a host computer assigned

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("rolling_", p.rolling);
    visit.group("stamps_", p.stamps);
  }
};

/// Returns the parameters for processing the merged readings of several IMUs with RollingSmoother, for programs that do
/// not use RollingOdometry.
RollingSmoother::Params rolling_smoother_params(const RollingOdometry::Params& params, const MergedRecordings& merged);

}  // namespace tumble
