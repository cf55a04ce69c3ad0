// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tumble {

/// Lowest accepted saturation limit, as a fraction of the stated range: rails.md (R67). The heuristic margin covers
/// devices that saturate below the range in their data sheet.
inline constexpr double kStatedRailMin = 0.85;

/// Margin below a saturation limit for scale errors, tilted planes of saturated readings, and motion between
/// neighbouring readings: rails.md (R54), (R75), rate_stream.md (R93).
inline constexpr double kNearRailRatio = 0.02;

/// maximum difference of equal readings, as a fraction of the saturation limit
inline constexpr double kEqualReadingsRatio = 2e-5;

}  // namespace tumble
