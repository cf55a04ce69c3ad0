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

/// Estimates the angular velocity of a body in flight, in contact or hand-held, over a whole recording. RateSmoother
/// estimates the rates for flight and contact. Where the body was probably hand-held while the gyro clipped,
/// HandHeldSmoother estimates the rates for hand-held motion. RegimeSmoother combines the rates of both smoothers by
/// the probability of hand-held motion (RegimeEvidence), which is constant during each saturated interval.
/// SpinTracker replaces the rate of a saturated axis during a steady spin.
class RegimeSmoother {
 public:
  struct Params : RegimeParams {
    RateSmoother::Params rate;
    HandHeldSmoother::Params hand_held;

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.rate);
      visit.group("carried_", p.hand_held);
      RegimeParams::fields(p, visit);
    }
  };
  struct Report {
    RateReport rate;
    bool judged = false;                     ///< RegimeSmoother estimated the probabilities below
    RegimeProbabilities probabilities{};     ///< mean probabilities over all samples
    double hand_held_probability_max = 0.0;  ///< largest probability of hand-held motion in a clipped segment
    bool hand_held_smoother_ran = false;     ///< HandHeldSmoother succeeded; `hand_held` contains its report
    HandHeldSmoother::Report hand_held;
    std::size_t spin_samples = 0;  ///< number of saturated samples that are probably in a steady spin
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit RegimeSmoother(const Params& params);

  /// Returns the status of RateSmoother; on error, `rates` is empty. If HandHeldSmoother fails, `rates` contains the
  /// result of RateSmoother.
  Status estimate(std::span<const ImuSample> samples, std::vector<RateState>& rates, Report& report) const {
    return estimate(samples, {}, rates, report);
  }
  /// Estimates the rates with additional IMUs on the body, like RateSmoother::estimate(). With additional IMUs, the
  /// rates are those of RateSmoother and `report.judged` is false.
  Status estimate(std::span<const ImuSample> samples, std::span<const std::vector<AuxiliaryReading>> auxiliary_imus,
                  std::vector<RateState>& rates, Report& report) const;

  /// Combines the rates of RateSmoother, given in `rates`, with the rates of HandHeldSmoother and SpinTracker. The
  /// caller must set `report.rate` to the report of RateSmoother before calling join().
  void join(std::span<const ImuSample> samples, std::vector<RateState>& rates, Report& report) const;

 private:
  void join_hand_held(std::span<const ImuSample> samples, std::vector<RateState>& rates, Report& report) const;
  void join_spin(std::span<const ImuSample> samples, bool further_imus, std::vector<RateState>& rates,
                 Report& report) const;
  bool estimate_hand_held(std::span<const ImuSample> samples, const ClippedReadings& known,
                          std::vector<RateState>& rates, HandHeldSmoother::Report& report) const;
  std::vector<double> segment_hand_held_probability(std::span<const RegimeProbabilities> probabilities,
                                                    const RateReport& report, std::span<const RateState> rates) const;

  Params params_;
  RateSmoother rate_;
  RegimeEvidence evidence_;
  HandHeldSmoother hand_held_;
  SpinTracker spin_;
};

}  // namespace tumble
