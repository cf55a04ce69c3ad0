// SPDX-License-Identifier: BSD-3-Clause
// Faults that sanitizers must detect: negative controls of the builds for memory, arithmetic and threads.
#include <cstdio>
#include <limits>
#include <string_view>
#include <thread>
#include <vector>

namespace {

int overflow(int count) {
  int out = std::numeric_limits<int>::max();
  out += count;
  return out;
}

int beyond_the_end(int count) {
  const std::vector<int> values(static_cast<std::size_t>(count), 1);
  return values.data()[count];
}

int race(int count) {
  int out = 0;
  std::thread other([&out, count] { out += count; });
  out += count;
  other.join();
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view fault = argc == 2 ? argv[1] : "";
  int (*const commit)(int) = fault == "overflow" ? overflow : fault == "memory" ? beyond_the_end : race;
  std::printf("%d\n", commit(argc));
}
