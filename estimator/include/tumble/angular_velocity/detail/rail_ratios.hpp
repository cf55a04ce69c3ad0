// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tumble {

/// The constants in rail_ratios.hpp separate saturated from unsaturated readings, as fractions of the range or of a
/// saturation limit. The fractions are heuristic.

/// Lowest accepted saturation limit, as a fraction of the stated range, see rails.md (R67). Saturation limits are
/// usually at the stated range or above (1.4 times for one device). The margin of kStatedRailMin covers devices that
/// saturate below the range in their data sheet.
inline constexpr double kStatedRailMin = 0.85;

/// Margin below a saturation limit, as a fraction of the limit. The margin covers scale errors, the tilt of saturation
/// planes, and motion between neighbouring readings. Readings below the margin are certainly unsaturated. See rails.md
/// (R54), (R75), rate_stream.md (R93).
inline constexpr double kNearRailRatio = 0.02;

/// Two readings count as equal if their difference is below kEqualReadingsRatio * saturation limit, as in RailDetector.
inline constexpr double kEqualReadingsRatio = 2e-5;

}  // namespace tumble
