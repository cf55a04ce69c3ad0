// SPDX-License-Identifier: BSD-3-Clause
// This header includes what the tests of the harness and of its programs share.
#pragma once

#include "scenarios/data_root.hpp"
#include "scenarios/errors.hpp"
#include "tests/testing.hpp"
#include "tests/tree.hpp"

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

/// Returns the scenarios, suites and models of this checkout.
inline scenarios::DataRoot tree_data() {
  return {source_dir()};
}

/// TemporaryFolder is a test with a temporary folder.
class TemporaryFolder : public ::testing::Test {
 protected:
  TemporaryFolder() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) / (std::string("tumble_") + test->test_suite_name() + "_" + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~TemporaryFolder() override { fs::remove_all(folder_); }

  void write(const fs::path& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

}  // namespace tumble::test
