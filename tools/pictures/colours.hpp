// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

/// The one palette of plots, pictures and replays.
namespace tumble::tools {

/// A colour as "#rrggbb", the same in plots and pictures.
struct Colour {
  const char* hex;
  std::array<float, 4> rgba() const;
};

/// So many methods have a colour of their own; further ones begin anew.
inline constexpr std::size_t kMethodColours = 6;

/// Of the truth, and of the index-th method of a picture. They stay apart for colour-blind readers too.
Colour truth_colour();
Colour method_colour(std::size_t index);
/// How often the colours were gone through before this one. What has one colour has another round, which a plot shows
/// by dashes, symbols or filling.
std::size_t colour_round(std::size_t index);

}  // namespace tumble::tools
