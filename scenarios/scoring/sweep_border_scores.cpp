// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/beside_truth.hpp"
#include "scenarios/scoring/families.hpp"
#include "tumble/common/types.hpp"

namespace tumble::scenarios {

namespace {

Eigen::Vector3d mean_rate_rad_s(const PoseState& a, const PoseState& b) {
  return so3::logarithm(b.orientation_W * a.orientation_W.conjugate()) / seconds(b.time_ns - a.time_ns);
}

struct Jumps {
  std::vector<double> velocity_m_s;
  std::vector<double> rate_rad_s;
};

Jumps border_jumps(const ScoredEstimate& scored) {
  const Estimate& estimate = scored.estimate();
  Jumps jumps;
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
    const Eigen::Vector3d dw =
        to_world.linear() * (mean_rate_rad_s(poses[2], poses[3]) - mean_rate_rad_s(poses[0], poses[1]));
    jumps.velocity_m_s.push_back((dv - (truths[2].velocity_W_m_s - truths[1].velocity_W_m_s)).norm());
    jumps.rate_rad_s.push_back(
        (dw - (mean_rate_rad_s(truths[2], truths[3]) - mean_rate_rad_s(truths[0], truths[1]))).norm());
  }
  return jumps;
}

bool jump_m_s(const ScoredEstimate& scored, double& value) {
  const Jumps& jumps = scored.once(border_jumps);
  if (jumps.velocity_m_s.empty()) return false;
  value = rms(jumps.velocity_m_s);
  return true;
}

bool jump_rad_s(const ScoredEstimate& scored, double& value) {
  const Jumps& jumps = scored.once(border_jumps);
  if (jumps.rate_rad_s.empty()) return false;
  value = rms(jumps.rate_rad_s);
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
      {{"sweep_jump_rad_s", Unit::rad_s,
        "rms jump of the estimated rate (derived from the attitudes) at sweep boundaries, after subtraction of the "
        "true change of rate",
        Sense::lower},
       Kind::slam,
       jump_rad_s},
  };
}

}  // namespace tumble::scenarios
