// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/rig_calibration_file.hpp"
#include "sim/parameters.hpp"
#include "sim/recording.hpp"
#include "tumble/angular_velocity/rate_smoother.hpp"

namespace tumble::scenarios {

/// Parameters of the smoother for an IMU: what its record states (lever arm, noise, ranges) and `parameters`, which
/// hold those of tumble_rate_parameters().
RateSmoother::Params smoother_params(const sim::ImuRecord& record, const sim::Values& parameters);

/// The method `tumble` that starts from what an earlier run has learnt of the rig (null: nothing) and leaves in `found`
/// (may be null) what this run has learnt; `found` stays as it is when the status is not ok and when the run learnt
/// nothing (health counter `rig_held`). What was learnt counts with four times its covariance, since rigs are handled
/// between runs, yet not more than what is assumed without it.
Estimate run_rate_tumble(const sim::Sensors& sensors, const sim::Values& parameters, const LearntRig* given,
                         LearntRig* found);

Method rate_tumble_lag();

}  // namespace tumble::scenarios
