// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

/// The header colours.hpp defines the palette that plots, pictures and replays share.
namespace tumble::tools {

struct Colour {
  const char* hex;
  std::array<float, 4> rgba() const;
};

/// kMethodColours is the number of methods with different colours. Further methods use these colours again.
inline constexpr std::size_t kMethodColours = 6;

/// Returns the colour of the truth, and of the method with an index. Colour-blind readers can distinguish the colours.
Colour truth_colour();
Colour method_colour(std::size_t index);
/// Returns how often all colours were used before the method with this index. A plot distinguishes methods with equal
/// colours by dashes, symbols or filling.
std::size_t colour_round(std::size_t index);

}  // namespace tumble::tools
