// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/methods/synthetic_recording.hpp"

namespace tumble::scenarios {

/// The recording is generated once.
inline const sim::Recording& rig() {
  static const sim::Recording recording = testing::synthetic_rig();
  return recording;
}

}  // namespace tumble::scenarios
