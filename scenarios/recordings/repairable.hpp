// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

struct ImportOption {
  std::string name, value;
};

/// RepairableInput is the exception for a recording that can be imported with another value of one import option.
class RepairableInput : public BadInput {
 public:
  RepairableInput(const std::string& message, ImportOption repair) : BadInput(message), repair_(std::move(repair)) {}
  const ImportOption& repair() const { return repair_; }

 private:
  ImportOption repair_;
};

}  // namespace tumble::scenarios
