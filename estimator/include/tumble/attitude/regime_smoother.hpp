// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tumble/angular_velocity/rate_smoother.hpp"
#include "tumble/attitude/carried_smoother.hpp"
#include "tumble/attitude/regimes.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// Estimates the angular velocity of a body in flight, in contact or hand-held over a whole recording. RateSmoother
/// assumes flight and contact. Where RegimeEvidence indicates that the body was hand-held while its gyro clipped,
/// CarriedSmoother is used as well. `either` combines the estimates of RateSmoother and CarriedSmoother.
/// CarriedSmoother runs only if it can change the result. RegimeStream is the streaming form.
///
/// Samples in and near a segment of clipped or suspect samples use the smallest hand-held probability among the
/// segment's nearby samples. The reason is a body that a hand releases: the flight determines nearby rates, but nothing
/// about hand-held motion a second later. Additional IMUs determine the rate in any kind of motion and are not used
/// here.
class RegimeSmoother {
 public:
  struct Params {
    RateSmoother::Params rate;
    RegimeEvidence::Params evidence;
    CarriedSmoother::Params carried;
    double carried_min = 0.02;  ///< minimum probability of hand-held motion that justifies a run of CarriedSmoother
    double near_s = 0.1;        ///< clipped samples within this time form one segment and affect each other

    /// Calls the visitor with the value, name, unit, bounds and meaning of every parameter (common/parameters.hpp).
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.rate);
      visit.group("evidence_", p.evidence);
      visit.group("carried_", p.carried);
      visit(p.carried_min,
            {"carried_min", "1", 0.0, 1.0, "least probability of hand-held motion for which its smoother runs"});
      visit(p.near_s, {"near_s", "s", 0.0, 10.0, "clipped samples within this time belong to one segment"});
    }
  };
  struct Report {
    RateReport rate;
    bool judged = false;               ///< kinds of motion were estimated; the following members are valid
    RegimeShares shares{};             ///< mean over the samples
    double carried_clipped_max = 0.0;  ///< largest probability of hand-held motion in a segment of clipped samples
    bool carried_asked = false;        ///< CarriedSmoother was run successfully; its report follows
    CarriedSmoother::Report carried;
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit RegimeSmoother(const Params& params);

  /// Computes one RateState per sample. Errors are those of RateSmoother; on error `rates` is empty. If CarriedSmoother
  /// fails, the result of RateSmoother is used.
  Status estimate(std::span<const ImuSample> samples, std::vector<RateState>& rates, Report& report) const;

  /// Combines the result of RateSmoother (`rates` with `report.rate`) with that of CarriedSmoother.
  void join(std::span<const ImuSample> samples, std::vector<RateState>& rates, Report& report) const;

 private:
  std::vector<double> carried_segments(std::span<const RegimeShares> shares, const RateReport& report,
                                       std::span<const RateState> rates) const;

  Params params_;
  RateSmoother rate_;
  RegimeEvidence evidence_;
  CarriedSmoother carried_;
};

}  // namespace tumble
