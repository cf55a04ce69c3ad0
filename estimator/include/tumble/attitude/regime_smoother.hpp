// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rate_smoother.hpp"
#include "tumble/attitude/clipped_readings.hpp"
#include "tumble/attitude/hand_held_smoother.hpp"
#include "tumble/attitude/regimes.hpp"
#include "tumble/attitude/spin_tracker.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// Estimates the angular velocity of a body in flight, in contact, hand-held or in a steady spin, over a whole
/// recording. RateSmoother estimates the rates under the assumption of flight and contact. HandHeldSmoother estimates
/// the rates again where the body was probably hand-held while the gyro clipped. RegimeSmoother combines the two rate
/// estimates by the probability of hand-held motion (RegimeEvidence). SpinTracker then replaces the rate of a saturated
/// axis during a steady spin. RegimeStream is the causal form of RegimeSmoother.
///
/// All samples of a clipped segment use the smallest probability of hand-held motion within and near the segment.
/// RegimeSmoother uses the smallest probability because a hand may release the body during the segment. Additional IMUs
/// determine the rate in any kind of motion, so RegimeSmoother omits HandHeldSmoother if there are additional IMUs.
class RegimeSmoother {
 public:
  struct Params {
    RateSmoother::Params rate;
    RegimeEvidence::Params evidence;
    HandHeldSmoother::Params hand_held;
    SpinTracker::Params spin;
    double hand_held_probability_min =
        0.02;                        ///< minimum probability of hand-held motion for which HandHeldSmoother runs
    double segment_gap_max_s = 0.1;  ///< clipped samples closer together than this form one segment

    /// Calls `visit` once for each parameter, with its value, name, unit, bounds and meaning.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.rate);
      visit.group("evidence_", p.evidence);
      visit.group("carried_", p.hand_held);
      visit.group("spin_", p.spin);
      visit(p.hand_held_probability_min,
            {"hand_held_probability_min", "1", 0.0, 1.0,
             "the smoother for hand-held motion runs if the probability of hand-held motion exceeds this value"});
      visit(p.segment_gap_max_s, {"segment_gap_max_s", "s", 0.0, 10.0,
                                  "clipped samples that are less than this time apart belong to one segment"});
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

  /// Estimates one RateState per sample. Returns the status of RateSmoother; on error, `rates` is empty. If
  /// HandHeldSmoother fails, `rates` contains the result of RateSmoother.
  Status estimate(std::span<const ImuSample> samples, std::vector<RateState>& rates, Report& report) const {
    return estimate(samples, {}, rates, report);
  }
  /// Estimates the rates with additional IMUs on the body, like RateSmoother::estimate(). If there are additional IMUs,
  /// HandHeldSmoother does not run and `report.judged` is false.
  Status estimate(std::span<const ImuSample> samples, std::span<const std::vector<AuxiliaryReading>> auxiliary_imus,
                  std::vector<RateState>& rates, Report& report) const;

  /// Combines `rates`, the result of RateSmoother, with the rates of HandHeldSmoother and SpinTracker, in place. The
  /// argument `report.rate` must contain the report of RateSmoother.
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
