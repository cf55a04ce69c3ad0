// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace tumble::scenarios {

std::string yaml_number(double value, const std::string& place);

std::string yaml_word(const std::string& text);

/// Returns the key `streams` with the seeds of random streams. Returns an empty text without seeds.
std::string streams_text(const std::map<std::string, std::uint64_t>& streams);

}  // namespace tumble::scenarios
