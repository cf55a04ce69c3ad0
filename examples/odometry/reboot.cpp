// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <iostream>
#include <string>
#include <tumble/tumble.hpp>

#include "driver.hpp"
#include "rig.hpp"

// Usage: reboot [FILE]. Starts with the calibration, map and pose in FILE, and saves them there at the end.
int main(int count, char** arguments) {
  const std::string file = count > 1 ? arguments[1] : "odometry.state";
  tumble::TumblingOdometry odometry(rig());  // lever arm and mounting must be those of the saved run
  bool ours = true;
  if (const auto state = driver::read_bytes(file); !state.empty()) {
    const tumble::Status status = odometry.load(state);
    ours = status.ok();
    if (!ours) std::fprintf(stderr, "starts without the saved state: %s\n", status.message().c_str());
  }
  while (const auto message = driver::next(std::cin)) {
    driver::add(*message, odometry);
    while (const auto done = odometry.take()) driver::print(*done);
  }
  if (ours && driver::write_bytes(odometry.save(), file)) return 0;
  std::fprintf(stderr, "%s was not changed\n", file.c_str());
  return 1;
}
