// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

/// colours.hpp defines the palette of plots, pictures and replays.
namespace tumble::tools {

struct Colour {
  const char* hex;
  std::array<float, 4> rgba() const;
};

/// Number of methods with different colours. Further methods reuse these colours.
inline constexpr std::size_t kMethodColours = 6;

/// Colours of the truth and of the methods by index. Colour-blind readers can distinguish them.
Colour truth_colour();
Colour method_colour(std::size_t index);
/// Returns how many earlier methods have the colour of this method. A plot distinguishes methods with equal colours by
/// dashes, symbols or filling.
std::size_t colour_round(std::size_t index);

}  // namespace tumble::tools
