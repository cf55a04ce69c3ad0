// SPDX-License-Identifier: BSD-3-Clause
#include "tools/pictures/colours.hpp"

#include <cstdlib>

namespace tumble::tools {

namespace {

// Any two of these colours, and the colour of the truth, differ by at least 30 in CIELAB, for normal vision and for
// protan, deutan and tritan deficiency (palette_test.cpp).
constexpr std::array<const char*, kMethodColours> kMethodHex = {"#ffbb22", "#8800ff", "#44ddff",
                                                                "#bb0000", "#224499", "#bbcc77"};
constexpr const char* kTruthHex = "#449977";

}  // namespace

std::array<float, 4> Colour::rgba() const {
  const long value = std::strtol(hex + 1, nullptr, 16);
  const auto channel = [&](int shift) { return static_cast<float>((value >> shift) & 0xFF) / 255.0f; };
  return {channel(16), channel(8), channel(0), 1.0f};
}

Colour truth_colour() {
  return {kTruthHex};
}
Colour method_colour(std::size_t index) {
  return {kMethodHex[index % kMethodHex.size()]};
}
std::size_t colour_round(std::size_t index) {
  return index / kMethodColours;
}

}  // namespace tumble::tools
