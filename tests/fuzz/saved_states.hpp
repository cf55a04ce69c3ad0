// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tumble::fuzz {

/// Corrupted saved states of TumblingOdometry (T) and RollingOdometry (R), see saved_edits.hpp.
void saved_states(const std::filesystem::path& file);

/// Corrupted saved states of streams: RateStream (R), RegimeStream (G), HandHeldStream (C), HandHeldPipeline (L),
/// RollingFilter (F), RollingSmoother (S).
void saved_streams(const std::filesystem::path& file);

}  // namespace tumble::fuzz
