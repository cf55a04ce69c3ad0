// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tumble/angular_velocity/rate_smoother.hpp"
#include "tumble/attitude/carried_smoother.hpp"
#include "tumble/attitude/regimes.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// Angular velocity of a body that flies, touches or is carried, over a whole recording: RateSmoother, which believes
/// in flight and contact, and where the readings say that a hand held the body while its gyro clipped (RegimeEvidence)
/// CarriedSmoother, joined by `either`. The other smoother is asked only where it may matter. RegimeStream is the same
/// as a stream.
///
/// A sample of a segment of clipped or doubted ones, or near about it, is believed to be carried as far as the least
/// carried sample of the segment is that is near to it: where a hand lets go, the flight tells the rate beside it, and
/// says nothing of what the hand does a second later. Not modelled: further IMUs, which tell the rate whoever holds the
/// body.
class RegimeSmoother {
 public:
  struct Params {
    RateSmoother::Params rate;
    RegimeEvidence::Params evidence;
    CarriedSmoother::Params carried;
    double carried_min = 0.02;  ///< a share of the carried body below this changes nothing worth a run
    double near_s = 0.1;  ///< clipped samples so close belong to one segment, and judge each other and what is so close

    /// Every number of it, stated once.
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
    bool judged = false;               ///< the regimes were; what follows is of use
    RegimeShares shares{};             ///< mean over the samples
    double carried_clipped_max = 0.0;  ///< largest share of the carried body in a segment of clipped samples
    bool carried_asked = false;        ///< and had an answer, whose report follows
    CarriedSmoother::Report carried;
  };

  /// Throws InvalidParams on a parameter outside of its bound.
  explicit RegimeSmoother(const Params& params);

  /// One RateState per sample. Trouble as of RateSmoother, `rates` is then empty; what CarriedSmoother has trouble with
  /// stays as RateSmoother has it.
  Status estimate(std::span<const ImuSample> samples, std::vector<RateState>& rates, Report& report) const;

  /// Joins what RateSmoother has said, `rates` with `report.rate`, with what CarriedSmoother says.
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
