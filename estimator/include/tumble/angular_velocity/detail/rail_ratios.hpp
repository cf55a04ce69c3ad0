// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tumble {

/// Lowest accepted saturation limit, as a fraction of the stated range: rails.md (R67). The heuristic margin covers
/// sensors that saturate below the range in their data sheet.
inline constexpr double kStatedRailMin = 0.85;

/// Readings within this margin below a saturation limit may be saturated, as a fraction of the limit: rails.md (R54),
/// (R75), rate_stream.md (R93). The margin covers scale errors, tilted saturation planes, and motion between two
/// readings.
inline constexpr double kNearRailRatio = 0.02;

/// maximum difference of readings that count as equal, as a fraction of the saturation limit
inline constexpr double kEqualReadingsRatio = 2e-5;

}  // namespace tumble
