// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tumble {

/// rail_ratios.hpp contains fractions of a range or a saturation level that separate saturated from unsaturated
/// readings. The fractions are heuristic.

/// Lowest accepted saturation level, as a fraction of the stated range, see rails.md (R67). Saturation levels are
/// usually at the stated range or above (1.4 times for one device). The margin of kStatedRailMin covers devices that
/// saturate below the range in their data sheet.
inline constexpr double kStatedRailMin = 0.85;

/// Margin below a saturation level, as a fraction of the level. The margin covers the scale of the calibration,
/// neighbouring readings along a tilted plane, and motion. Readings below the margin are certainly unsaturated. See
/// rails.md (R54), (R75), rate_stream.md (R93).
inline constexpr double kNearRailRatio = 0.02;

/// Readings whose difference is below the fraction kEqualReadingsRatio of the saturation level are equal, as in
/// RailDetector.
inline constexpr double kEqualReadingsRatio = 2e-5;

}  // namespace tumble
