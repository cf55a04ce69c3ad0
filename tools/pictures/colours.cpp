// SPDX-License-Identifier: BSD-3-Clause
#include "tools/pictures/colours.hpp"

#include <cstdlib>

namespace tumble::tools {

namespace {

// chosen to stay apart for colour-blind readers (Okabe and Ito) on grass, stone and floor
constexpr std::array<const char*, 6> kMethodColours = {"#e69f00", "#cc79a7", "#0072b2",
                                                       "#d55e00", "#56b4e9", "#f0e442"};
constexpr const char* kTruthColour = "#009e73";

}  // namespace

std::array<float, 4> Colour::rgba() const {
  const long value = std::strtol(hex + 1, nullptr, 16);
  const auto channel = [&](int shift) { return static_cast<float>((value >> shift) & 0xFF) / 255.0f; };
  return {channel(16), channel(8), channel(0), 1.0f};
}

Colour truth_colour() {
  return {kTruthColour};
}
Colour method_colour(std::size_t index) {
  return {kMethodColours[index % kMethodColours.size()]};
}

}  // namespace tumble::tools
