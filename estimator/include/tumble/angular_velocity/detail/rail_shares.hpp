// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tumble {

/// Shares of a range or of a rail by which a reading is taken to be at a rail, or to be free of it. Heuristic.

/// Of the range that a device states: below it no rail is looked for, and none is heard. rails.md (R67). A rail lies at
/// what is stated or beyond (of one at hand at 1.4 times); so much less is left to a device that does not keep its
/// word.
inline constexpr double kStatedRailMin = 0.85;

/// Of a rail, below it: what a calibration (its scale), a tilted element's neighbours in time and motion beside make of
/// where a reading at it stands. Further below a reading is one for sure. rails.md (R54), (R75), rate_stream.md (R94).
inline constexpr double kBesideRail = 0.02;

/// Of a rail: readings closer than this are equal, as RailDetector has it.
inline constexpr double kEqualShare = 2e-5;

}  // namespace tumble
