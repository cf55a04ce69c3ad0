// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tumble::fuzz {

/// Saved states of the doors, TumblingOdometry (T) and RollingOdometry (R), spoiled: saved_edits.hpp.
void saved_states(const std::filesystem::path& file);

/// The same of streams: RateStream (R), RegimeStream (G), CarriedStream (C), CarriedLive (L), RollingFilter (F),
/// RollingSmoother (S).
void saved_streams(const std::filesystem::path& file);

}  // namespace tumble::fuzz
