// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstdio>
#include <exception>

#include "sim/simulate.hpp"

/// Common code of the programs in this folder that are called by hand.
namespace tumble::bench {

/// Parses the command line to a Request and runs it. Prints the usage for wrong arguments, and the message of an
/// exception. Returns the exit status, which is 2 for both.
template <typename Request>
int run_program(int count, char** words, const char* usage, bool (*parse)(int, char**, Request&),
                int (*run)(const Request&)) {
  Request request;
  if (!parse(count, words, request)) {
    std::fprintf(stderr, "usage: %s\n", usage);
    return 2;
  }
  try {
    return run(request);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}

/// Calls `work(seed)` for each seed from first to last. A draw that the simulation rejects is skipped with a message.
template <typename Work>
void for_each_draw(std::uint64_t first, std::uint64_t last, Work&& work) {
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    try {
      work(seed);
    } catch (const sim::SimulationFailure& failure) {
      std::printf("draw %llu left out: %s\n", static_cast<unsigned long long>(seed), failure.what());
    }
  }
}

}  // namespace tumble::bench
