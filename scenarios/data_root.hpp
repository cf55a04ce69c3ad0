// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tumble::scenarios {

struct DataRoot {
  std::filesystem::path root;
  std::filesystem::path models() const { return root / "models"; }
  std::filesystem::path data_sheets() const { return root / "models" / "sensors"; }
  std::filesystem::path catalogue() const { return root / "scenarios" / "catalogue"; }
  std::filesystem::path regressions() const { return root / "scenarios" / "regressions"; }
  std::filesystem::path suites() const { return root / "scenarios" / "suites"; }
  std::filesystem::path gates() const { return root / "scenarios" / "gates"; }
};

}  // namespace tumble::scenarios
