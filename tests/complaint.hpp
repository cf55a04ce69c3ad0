// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/errors.hpp"

namespace tumble::test {

/// Returns the message of the BadInput that `call` throws, or an empty string when it throws none.
template <class Call>
std::string complaint(Call&& call) {
  try {
    call();
  } catch (const scenarios::BadInput& error) {
    return error.what();
  }
  return "";
}

}  // namespace tumble::test
