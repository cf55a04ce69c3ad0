// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tumble::fuzz {

/// Saved states of the door, spoiled: the file says of which class (T or R) and then how, six bytes an edit: what
/// (modulo 5), where (4 bytes, little-endian, modulo the size), by which byte. Length and checksum are made to fit
/// again, since no fuzzer would find them. BadInput where the state is refused, or the file is none; what is taken has
/// to say the same when it is saved again, and go on.
///
/// The edits are of states that are made here and not of files, so that a seed stays good when the states change.
void saved_states(const std::filesystem::path& file);

}  // namespace tumble::fuzz
