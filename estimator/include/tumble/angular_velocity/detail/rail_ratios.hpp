// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tumble {

/// The fractions of a range or of a saturation limit are heuristic.

/// Lowest accepted saturation limit, as a fraction of the stated range, see rails.md (R67). Saturation limits are
/// usually at the stated range or above (1.4 times for one device). The margin covers devices that saturate below the
/// range in their data sheet.
inline constexpr double kStatedRailMin = 0.85;

/// The margin below a saturation limit covers scale errors, tilted saturation planes, and motion between neighbouring
/// readings. See rails.md (R54), (R75), rate_stream.md (R93).
inline constexpr double kNearRailRatio = 0.02;

/// maximum difference of equal readings, as a fraction of the saturation limit
inline constexpr double kEqualReadingsRatio = 2e-5;

}  // namespace tumble
