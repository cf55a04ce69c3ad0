// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/estimates/method.hpp"
#include "sim/recording.hpp"

namespace tumble::tools {

scenarios::Frame frame_of(const std::string& name, bool has_imu);

struct GivenEstimate {
  std::filesystem::path path, recording;
  scenarios::Frame tum_frame;  ///< frame of the poses in a TUM file
};

/// `truth` may be null.
scenarios::Estimate read_given(const GivenEstimate& given, const sim::Sensors& sensors, const sim::Truth* truth,
                               scenarios::Kind& kind, std::string& method);

}  // namespace tumble::tools
