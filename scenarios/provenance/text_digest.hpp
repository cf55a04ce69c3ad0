// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

namespace tumble::scenarios {

std::string digest_of_texts(std::span<const std::string> texts);

}  // namespace tumble::scenarios
