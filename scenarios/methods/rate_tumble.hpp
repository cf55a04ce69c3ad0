// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/rate_regimes.hpp"
#include "scenarios/methods/rig_calibration_file.hpp"
#include "scenarios/methods/settings.hpp"
#include "sim/parameters.hpp"
#include "sim/recording.hpp"
#include "tumble/angular_velocity/rate_smoother.hpp"

namespace tumble::scenarios {

/// Parameters of rate/tumble, with the library's own defaults.
const Settings<RateSmoother::Params>& rate_tumble_settings();

/// Those of them that a record states where its data sheet does.
const std::vector<std::string>& stated_densities();

/// `params` with what the record of an IMU states: lever arm, noise, ranges.
RateSmoother::Params stated_params(const sim::ImuRecord& record, RateSmoother::Params params);

/// The same for the defaults of `settings`, and then what `parameters` say.
RateSmoother::Params smoother_params(const sim::ImuRecord& record, const Settings<RateSmoother::Params>& settings,
                                     const sim::Values& parameters);

/// What the smoother makes of a recording, that of carried bodies asked where it may matter (join_regimes).
struct SmoothedRates {
  std::vector<RateState> rates;  ///< one per sample
  RateReport report;
  CarriedBody carried;  ///< as join_regimes returns it
  std::size_t auxiliary_imus = 0;
};

/// Rates of `samples`, which may have other readings than the recording. Adds what the smoother tells of its run to the
/// health and the doubts of `told`.
Status tumble_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples, RateSmoother::Params params,
                    SmoothedRates& out, Estimate& told);

/// The other IMUs of a recording on the same body, at the stamps of `samples`: those of its first further IMUs that are
/// not `imu_reference`, at most kAuxiliaryImusMax. Adds their mountings, as calibrated, to `model`. Trouble: that of a
/// record.
Status auxiliary_readings(const sim::Sensors& sensors, std::span<const ImuSample> samples, RateModelParams& model,
                          std::vector<std::vector<AuxiliaryReading>>& out);

/// The method `tumble` that starts from what an earlier run has learnt of the rig (null: nothing) and leaves in `found`
/// (may be null) what this run has learnt; `found` stays as it is when the status is not ok and when the run learnt
/// nothing, because it had to hold the rig to what was known and no rail is sure (with_rails). What was learnt counts
/// with four times its covariance, since rigs are handled between runs, yet not more than what is assumed without it.
Estimate run_rate_tumble(const sim::Sensors& sensors, const sim::Values& parameters, const LearntRig* given,
                         std::optional<LearntRig>* found);

/// The same for the stream `tumble_lag`. It has learnt of the constants where they are better known than before.
Estimate run_rate_tumble_lag(const sim::Sensors& sensors, const sim::Values& parameters, const LearntRig* given,
                             std::optional<LearntRig>* found);

/// Makes what was learnt of the rig the start of a smoother: lever arm and inertia with four times their covariance,
/// see above, and the rails. Biases are of one switch-on and start anew.
void start_from_learnt(const LearntRig& rig, RateSmoother::Params& params);

/// What is known of a rig before a run: what it is given, if anything, else what `model` assumes.
LearntRig known_before(const LearntRig* given, const RateModelParams& model);

/// What several runs on one rig start from and what they have learnt.
struct Learning {
  std::optional<LearntRig> given;  ///< none: they start from nothing
  std::optional<LearntRig> of_batch, of_stream;
  /// What is to be kept: of the batch where it ran, since it saw all of the recording at once, unless that learnt of
  /// rails alone and the stream of more; null: nothing.
  const LearntRig* found() const;
};

/// How far what two runs have learnt of a rig is apart, in deviations of the difference per root of the unknowns: of
/// lever arm and inertia, the larger. Of one rig 0.14 to 1.0 in eighteen pairs of runs down a hill, 2.3 and more with
/// an inertia of 30 % off. `trust` as start_from has it, of `before`.
double distance_of_rigs(const RigCalibration& before, const RigCalibration& now, double trust);

/// `method` as a method that starts from and adds to `learning`, which must outlive it. One that starts from something
/// runs once more without it: where that tells another rig (distance_of_rigs) the estimate doubts what it was given,
/// and learns nothing. Throws BadInput for a method that learns nothing of the rig: all but rate/tumble and
/// rate/tumble_lag.
Method learning_method(const Method& method, Learning& learning);

Method rate_tumble_lag();

}  // namespace tumble::scenarios
