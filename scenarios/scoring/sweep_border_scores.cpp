// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/beside_truth.hpp"
#include "scenarios/scoring/families.hpp"

namespace tumble::scenarios {

namespace {

std::vector<double> border_jumps_m_s(const ScoredEstimate& scored) {
  const Estimate& estimate = scored.estimate();
  std::vector<double> jumps;
  const TruthTrack& truth = truth_track(scored);
  const Alignment& alignment = paired_track(scored).alignment;
  for (std::size_t k = 1; k < estimate.sweeps.size(); ++k) {
    const auto& before = estimate.sweeps[k - 1].trajectory;
    const auto& after = estimate.sweeps[k].trajectory;
    if (before.size() < 2 || after.size() < 2) continue;
    if (after.front().time_ns - before.back().time_ns > after[1].time_ns - after[0].time_ns) continue;
    const PoseState poses[4] = {before[before.size() - 2], before.back(), after[0], after[1]};
    PoseState truths[4];
    bool covered = true;
    for (int j = 0; j < 4; ++j) {
      covered = covered && truth.covers(poses[j].time_ns);
      if (covered) truths[j] = truth.pose(poses[j].time_ns);
      covered = covered && truths[j].velocity_W_m_s.allFinite();  // velocity unknown next to gaps
    }
    if (!covered) continue;
    const Eigen::Isometry3d to_world = alignment.transform();
    const Eigen::Vector3d dv = to_world.linear() * (poses[2].velocity_W_m_s - poses[1].velocity_W_m_s);
    jumps.push_back((dv - (truths[2].velocity_W_m_s - truths[1].velocity_W_m_s)).norm());
  }
  return jumps;
}

bool jump_m_s(const ScoredEstimate& scored, double& value) {
  const std::vector<double> jumps = border_jumps_m_s(scored);
  if (jumps.empty()) return false;
  value = rms(jumps);
  return true;
}

}  // namespace

std::vector<Metric> sweep_border_metrics() {
  return {
      {{"sweep_jump_m_s", Unit::m_s,
        "rms jump of the estimated velocity at sweep boundaries, after subtraction of the true change of velocity",
        Sense::lower, Place::held},
       Kind::slam,
       jump_m_s},
  };
}

}  // namespace tumble::scenarios
