// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

namespace tumble::scenarios {

/// Digest of a list of texts: the same texts in the same order, the same digest.
std::string digest_of_texts(std::span<const std::string> texts);

}  // namespace tumble::scenarios
