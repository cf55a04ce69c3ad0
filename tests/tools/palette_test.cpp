// SPDX-License-Identifier: BSD-3-Clause
// The test checks that the palette's colours are distinguishable by everybody: the distances are in CIELAB, as seen by
// normal, protan, deutan and tritan eyes.
#include "tests/testing.hpp"
#include "tools/pictures/colours.hpp"

namespace tumble::tools {
namespace {

/// Converts sRGB to linear light (IEC 61966-2-1).
Vector3d linear(Colour colour) {
  const auto rgba = colour.rgba();
  const Vector3d srgb(rgba[0], rgba[1], rgba[2]);
  return srgb.unaryExpr([](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); });
}

/// Converts linear sRGB to CIELAB under D65 (CIE 15).
Vector3d lab(const Vector3d& rgb) {
  Matrix3d to_xyz;
  to_xyz << 0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522, 0.0721750, 0.0193339, 0.1191920, 0.9503041;
  const Vector3d white = to_xyz * Vector3d::Ones();
  const Vector3d f = (to_xyz * rgb.cwiseMax(0.0).cwiseMin(1.0)).cwiseQuotient(white).unaryExpr([](double t) {
    return t > 216.0 / 24389.0 ? std::cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
  });
  return {116.0 * f.y() - 16.0, 500.0 * (f.x() - f.y()), 200.0 * (f.y() - f.z())};
}

/// Returns what eyes without red, without green, or without blue cones see of linear light (Machado, Oliveira,
/// Fernandes, *A physiologically-based model for simulation of color vision deficiency*, IEEE TVCG 15:1291, 2009;
/// severity 1).
std::array<Matrix3d, 4> eyes() {
  Matrix3d protan, deutan, tritan;
  protan << 0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998;
  deutan << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881;
  tritan << 1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.303900;
  return {Matrix3d::Identity(), protan, deutan, tritan};
}

/// Returns the distance between the two nearest colours, for the eyes that distinguish them worst.
double smallest_distance(const std::vector<Colour>& colours) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Matrix3d& eye : eyes()) {
    for (std::size_t i = 0; i < colours.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j)
        smallest = std::min(smallest, (lab(eye * linear(colours[i])) - lab(eye * linear(colours[j]))).norm());
    }
  }
  return smallest;
}

std::vector<Colour> palette() {
  std::vector<Colour> out = {truth_colour()};
  for (std::size_t i = 0; i < kMethodColours; ++i) out.push_back(method_colour(i));
  return out;
}

/// Returns the contrast of the luminances (WCAG 2.2).
double contrast(Colour a, Colour b) {
  const Vector3d weights(0.2126, 0.7152, 0.0722);
  const double first = weights.dot(linear(a)) + 0.05, second = weights.dot(linear(b)) + 0.05;
  return std::max(first, second) / std::min(first, second);
}

TEST(Cielab, IsThatOfTheTables) {
  EXPECT_LT((lab(linear({"#ffffff"})) - Vector3d(100.0, 0.0, 0.0)).norm(), 1e-3);
  EXPECT_LT((lab(linear({"#000000"}))).norm(), 1e-9);
  // colour tables give these values for sRGB's red
  EXPECT_LT((lab(linear({"#ff0000"})) - Vector3d(53.24, 80.09, 67.20)).norm(), 0.02);
  for (const Matrix3d& eye : eyes())
    EXPECT_LT((eye * Vector3d::Ones() - Vector3d::Ones()).norm(), 1e-4) << "grey stays";
}

TEST(Palette, StaysApartForColourBlindEyesToo) {
  EXPECT_GT(smallest_distance(palette()), 30.0);
  // the negative controls are the earlier palette, of which two colours look alike to deutan eyes, and a palette with
  // one colour twice
  const std::vector<Colour> before = {{"#009e73"}, {"#e69f00"}, {"#cc79a7"}, {"#0072b2"},
                                      {"#d55e00"}, {"#56b4e9"}, {"#f0e442"}};
  EXPECT_LT(smallest_distance(before), 20.0);
  EXPECT_EQ(smallest_distance({{"#123456"}, {"#123456"}}), 0.0);
}

TEST(Palette, IsSeenOnLightAndDarkPages) {
  for (const Colour colour : palette()) {
    EXPECT_GT(contrast(colour, {"#ffffff"}), 1.5) << colour.hex;
    EXPECT_GT(contrast(colour, {"#1d2327"}), 1.5) << colour.hex;
  }
  EXPECT_NEAR(contrast({"#ffffff"}, {"#000000"}), 21.0, 1e-9);
  EXPECT_LT(contrast({"#f0e442"}, {"#ffffff"}), 1.5) << "negative control: the yellow that was";
}

}  // namespace
}  // namespace tumble::tools
