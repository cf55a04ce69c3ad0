// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/rate_smoother.hpp"
#include "tumble/attitude/detail/clipped_readings.hpp"
#include "tumble/attitude/detail/hand_held_smoother.hpp"
#include "tumble/attitude/detail/regime_params.hpp"
#include "tumble/attitude/detail/regimes.hpp"
#include "tumble/attitude/detail/spin_tracker.hpp"

namespace tumble {

/// Estimates the angular velocity of a body in flight, in contact or hand-held, over a whole recording.
/// AngularRateSmoother estimates the rates for flight and contact. HandHeldSmoother estimates the rates for saturated
/// intervals in which the body was probably hand-held. Both rates are combined by the probability of hand-held motion
/// (MotionRegimeEvidence), which is constant in each saturated interval. SpinTracker replaces the rate of a saturated
/// axis during a steady spin.
class MotionRegimeSmoother {
 public:
  struct Params : MotionRegimeParams {
    AngularRateSmoother::Params rate;
    HandHeldSmoother::Params hand_held;

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.rate);
      visit.group("carried_", p.hand_held);
      MotionRegimeParams::fields(p, visit);
    }
  };
  struct Report {
    AngularRateReport rate;
    bool regimes_estimated = false;  ///< false: the probabilities below were not estimated
    RegimeProbabilities probabilities{};
    double hand_held_probability_max = 0.0;  ///< largest probability of hand-held motion in a clipped segment
    bool hand_held_smoother_ran = false;     ///< true: `hand_held` contains the report of HandHeldSmoother
    HandHeldSmoother::Report hand_held;
    std::size_t spin_samples = 0;  ///< saturated samples that are probably in a steady spin
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit MotionRegimeSmoother(const Params& params);

  /// Estimates the rates at all samples. Returns the status of AngularRateSmoother; on error, `rates` is empty. If
  /// HandHeldSmoother fails, `rates` contains the result of AngularRateSmoother.
  Status estimate(std::span<const ImuSample> samples, std::vector<AngularRateState>& rates, Report& report) const {
    return estimate(samples, {}, rates, report);
  }
  /// Estimates the rates with additional IMUs on the body, like AngularRateSmoother::estimate(). With additional IMUs,
  /// the rates are those of AngularRateSmoother and `report.regimes_estimated` is false.
  Status estimate(std::span<const ImuSample> samples, std::span<const std::vector<AuxiliaryReading>> auxiliary_imus,
                  std::vector<AngularRateState>& rates, Report& report) const;

 private:
  void join_hand_held_rates(std::span<const ImuSample> samples, std::vector<AngularRateState>& rates,
                            Report& report) const;
  void join_spin_rates(std::span<const ImuSample> samples, bool further_imus, std::vector<AngularRateState>& rates,
                       Report& report) const;
  bool estimate_hand_held(std::span<const ImuSample> samples, const ClippedReadings& known,
                          std::vector<AngularRateState>& rates, HandHeldSmoother::Report& report) const;
  std::vector<double> segment_hand_held_probability(std::span<const RegimeProbabilities> probabilities,
                                                    const AngularRateReport& report,
                                                    std::span<const AngularRateState> rates) const;

  Params params_;
  AngularRateSmoother rate_;
  MotionRegimeEvidence regime_evidence_;
  HandHeldSmoother hand_held_;
  SpinTracker spin_;
};

}  // namespace tumble
