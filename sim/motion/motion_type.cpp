// SPDX-License-Identifier: BSD-3-Clause
#include "sim/motion/motion_type.hpp"

#include <array>

#include "sim/registry.hpp"

namespace tumble::sim {

std::span<const MotionType* const> all_motion_types() {
  static const std::array kTypes = {&push_motion(),      &throw_motion(),     &drop_motion(),
                                    &hand_roll_motion(), &hand_path_motion(), &twirl_motion(),
                                    &stroll_motion(),    &swing_motion(),     &launch_motion()};
  return kTypes;
}

const MotionType& find_motion_type(std::string_view name) {
  return find_entry(all_motion_types(), name, "motion");
}

}  // namespace tumble::sim
