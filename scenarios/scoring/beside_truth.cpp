// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/beside_truth.hpp"

namespace tumble::scenarios {

namespace {

TruthTrack make_track(const ScoredEstimate& scored) {
  return TruthTrack(scored.truth(), scored.estimate().frame);
}

PairedTrack pair_track(const ScoredEstimate& scored) {
  return pair_poses(scored.estimate(), truth_track(scored));
}

ClippingTruth make_clipping(const ScoredEstimate& scored) {
  return ClippingTruth(scored.sensors(), scored.truth());
}

std::vector<PairedRate> pair_rates(const ScoredEstimate& scored) {
  const ClippingTruth& truth = clipping_truth(scored);
  std::vector<PairedRate> pairs;
  pairs.reserve(scored.estimate().rates.size());
  for (const AngularRateState& rate : scored.estimate().rates) {
    pairs.push_back({&rate, truth.at(rate.time_ns), truth.index_at(rate.time_ns).value_or(0)});
  }
  return pairs;
}

}  // namespace

const TruthTrack& truth_track(const ScoredEstimate& scored) {
  return scored.once(make_track);
}

const PairedTrack& paired_track(const ScoredEstimate& scored) {
  return scored.once(pair_track);
}

const ClippingTruth& clipping_truth(const ScoredEstimate& scored) {
  return scored.once(make_clipping);
}

const std::vector<PairedRate>& paired_rates(const ScoredEstimate& scored) {
  return scored.once(pair_rates);
}

}  // namespace tumble::scenarios
