// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "scenarios/data_root.hpp"

namespace tumble::scenarios {

std::string data_digest(const DataRoot& data);

std::string digest_of_texts(std::span<const std::string> texts);

}  // namespace tumble::scenarios
