// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "tumble/common/types.hpp"

namespace tumble::testing {

/// One trial of BROAD (D. Laidig, M. Caruso, A. Cereatti, T. Seel, Data 2021, 6(7), 72; CC BY 4.0), as recorded.
struct BroadTrial {
  std::vector<ImuSample> samples;
  std::vector<Eigen::Quaterniond> q_ref;  ///< body to world (z up); NaN where the markers were occluded
  std::vector<bool> moving;
};

/// Returns the numbers of the available trials: the simulated one ("00", tests/stand_ins) and the eight real ones where
/// they exist.
std::vector<std::string> broad_trials();

/// Returns the simulated trial and two real ones where they exist, for tests that must be fast.
std::vector<std::string> few_broad_trials();

/// Returns the folder of the real trials, or an empty string when the shared data are absent.
std::string broad_folder();

/// Reads the trial whose file name begins with `number` ("05"). Throws std::runtime_error when the trial cannot be
/// read.
BroadTrial read_broad_trial(const std::string& folder, const std::string& number);

/// Reads one of `broad_trials()`.
BroadTrial read_broad_trial(const std::string& number);

/// A BroadError contains root mean square errors in degrees as BROAD defines them; samples without reference are left
/// out.
struct BroadError {
  double inclination_motion_deg = 0.0;
  double heading_motion_deg = 0.0;
  double inclination_rest_deg = 0.0;
};

/// Returns the errors of `q_WI`, one per sample, after its heading is aligned at the first sample with reference.
BroadError score(const BroadTrial& trial, const std::vector<Eigen::Quaterniond>& q_WI);

}  // namespace tumble::testing
