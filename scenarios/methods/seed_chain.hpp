// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "scenarios/baselines/mapping/trimmed_icp.hpp"
#include "scenarios/methods/method.hpp"
#include "scenarios/methods/settings.hpp"
#include "sim/parameters.hpp"
#include "tumble/common/imu.hpp"

namespace tumble::scenarios {

/// What of the published chain may be varied; the known errors as launched.
struct SeedParams {
  double skew_sigma_m_s = 0.25;
  baselines::TrimmedIcp::Params icp;
  bool late_velocity = true, voxel_averages_time = true, abort_ends_mapping = false;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.skew_sigma_m_s, {"skew_sigma_m_s", "m/s", 0.0, 100.0,
                             "growth of a point's uncertainty over the sweep (time weighting); 0: none", Rank::first});
    visit(p.late_velocity, on_off("late_velocity",
                                  "1: velocity fed back is the mean since the last sweep taken for the present one, "
                                  "half a sweep late, as launched",
                                  Rank::first));
    visit(p.voxel_averages_time, on_off("voxel_averages_time",
                                        "1: points of a voxel share their mean time, also across the seam of the "
                                        "sweep, as launched; 0: mean variance",
                                        Rank::first));
    visit(p.abort_ends_mapping, on_off("abort_ends_mapping",
                                       "1: a registration that aborts ends the mapper, as launched; 0: odometry goes "
                                       "on alone for that sweep",
                                       Rank::first));
    visit.group("", p.icp);
  }
};

/// The published chain behind a rate method (Deschenes et al., ICRA 2024, with the constants of the authors' launch
/// files): Madgwick's attitude, accelerometer odometry whose velocity the registration feeds back, deskewing to the
/// start of the sweep (of one that was cast at an instant: to that), time weighting, trimmed point-to-plane
/// registration of voxelised points, a map that grows where it is empty. `estimate.rates` are given; the constants that
/// one may want to vary, and the chain's own errors, are parameters.
void run_seed_chain(const sim::Sensors& sensors, std::span<const ImuSample> samples, const sim::Values& parameters,
                    Estimate& estimate);

const Settings<SeedParams>& seed_settings();

}  // namespace tumble::scenarios
