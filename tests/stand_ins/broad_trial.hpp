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

/// Numbers of the trials at hand: the stand-in's ("00", tests/stand_ins) and the eight real ones where they are there.
std::vector<std::string> broad_trials();

/// Folder of the real trials; empty when the shared data are not there.
std::string broad_folder();

/// Reads the trial whose file name begins with `number` ("05"). Throws std::runtime_error when it cannot.
BroadTrial read_broad_trial(const std::string& folder, const std::string& number);

/// One of `broad_trials()`.
BroadTrial read_broad_trial(const std::string& number);

/// Root mean square errors in degrees as BROAD defines them, samples without reference left out.
struct BroadError {
  double inclination_motion_deg = 0.0;
  double heading_motion_deg = 0.0;
  double inclination_rest_deg = 0.0;
};

/// Errors of `q_WI`, one per sample, after its heading is aligned at the first sample with reference.
BroadError score(const BroadTrial& trial, const std::vector<Eigen::Quaterniond>& q_WI);

}  // namespace tumble::testing
