// SPDX-License-Identifier: BSD-3-Clause
// Links only if the memory layout equals that of the library.
#include <cstdio>
#include <tumble/common/types.hpp>

int main() {
  std::puts(tumble::to_string(tumble::check_sample({}).error_code));
}
