// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

namespace tumble::tools {

/// A colour as "#rrggbb", the same in plots and pictures.
struct Colour {
  const char* hex;
  std::array<float, 4> rgba() const;
};
/// Of the truth, and of the index-th method of a picture.
Colour truth_colour();
Colour method_colour(std::size_t index);

}  // namespace tumble::tools
