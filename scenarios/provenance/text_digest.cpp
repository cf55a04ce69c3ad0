// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/provenance/text_digest.hpp"

#include "scenarios/provenance/hasher.hpp"

namespace tumble::scenarios {

std::string digest_of_texts(std::span<const std::string> texts) {
  Hasher hasher;
  for (const std::string& text : texts) hasher.text(text);
  return hasher.hex();
}

}  // namespace tumble::scenarios
