// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

namespace tumble::tools {

struct Colour {
  const char* hex;
  std::array<float, 4> rgba() const;
};

inline constexpr std::size_t kMethodColours = 6;

/// Colour-blind readers can distinguish the colours of the truth and of the methods.
Colour truth_colour();
Colour method_colour(std::size_t index);
/// Returns how many earlier methods have the colour of this method; a plot distinguishes such methods by dashes,
/// symbols or filling.
std::size_t colour_round(std::size_t index);

}  // namespace tumble::tools
