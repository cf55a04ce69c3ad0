// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace tumble {

/// Mode of contact between the rolling sphere and the floor.
enum class ContactMode : std::uint8_t {
  grip,     ///< the contact point is at rest; the floor is level
  slip,     ///< the contact point moves along the floor: the sphere spins too fast or slides
  bump,     ///< the contact point also rises or falls: an obstacle, or flight
  incline,  ///< the contact point is at rest; the floor has an estimated slope
  uneven,   ///< the contact point is at rest; the floor rises and falls about the level
};
inline constexpr int kContactModes = 5;

/// Returns true if the contact point may move along the floor in the contact mode `mode`.
inline bool may_slip(ContactMode mode) {
  return mode == ContactMode::slip || mode == ContactMode::bump;
}

}  // namespace tumble
