// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/estimates/method.hpp"
#include "tools/tumble/found.hpp"
#include "tools/tumble/importing.hpp"
#include "tools/tumble/prior_map_options.hpp"
#include "tools/tumble/verb_options.hpp"

namespace tumble::tools {

/// Options with which `tumble odometry` and `tumble doctor` read a recording and choose the estimator.
struct OdometryOptions {
  ImportOptions input;
  std::string method;
  bool live = false;
  PriorMapOptions prior_map;
  std::vector<double> own_body_m;
  std::vector<double> T_base_imu;
  std::vector<std::string> parameters;
};

void declare_odometry_options(VerbOptions& verb, OdometryOptions& options);

/// Throws BadInput if options contradict each other or are not valid.
void check_odometry_options(const OdometryOptions& options);

struct OdometrySetup {
  std::vector<RecordingSetting> found;  ///< settings of the recording
  scenarios::Method method;             ///< with its parameters
};

/// Chooses the method, detects missing settings of the recording, and stores them in the recording.
OdometrySetup set_up_odometry(const Session& session, const OdometryOptions& options, OpenRecording& recording);

}  // namespace tumble::tools
