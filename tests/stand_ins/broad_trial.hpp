// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "tumble/common/imu.hpp"

namespace tumble::testing {

/// One trial of BROAD (D. Laidig, M. Caruso, A. Cereatti, T. Seel, Data 2021, 6(7), 72; CC BY 4.0), as recorded.
struct BroadTrial {
  std::vector<ImuSample> samples;
  std::vector<Eigen::Quaterniond> q_ref;  ///< body to world (z up); NaN where the markers were occluded
  std::vector<bool> moving;
};

/// Numbers of the available trials: the stand-in ("00", tests/stand_ins), and the eight real ones if they are
/// available.
std::vector<std::string> broad_trials();

/// Folder of the real trials; empty if the shared data are missing.
std::string broad_folder();

/// Reads the trial whose file name starts with `number` ("05"). Throws std::runtime_error if it cannot.
BroadTrial read_broad_trial(const std::string& folder, const std::string& number);

/// Reads one of `broad_trials()`.
BroadTrial read_broad_trial(const std::string& number);

/// Root mean square errors in degrees as defined by BROAD, without samples that have no reference.
struct BroadError {
  double inclination_motion_deg = 0.0;
  double heading_motion_deg = 0.0;
  double inclination_rest_deg = 0.0;
};

/// Errors of `q_WI`, one per sample, after the heading is aligned at the first sample with reference.
BroadError score(const BroadTrial& trial, const std::vector<Eigen::Quaterniond>& q_WI);

}  // namespace tumble::testing
