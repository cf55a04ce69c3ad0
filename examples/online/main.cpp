// SPDX-License-Identifier: BSD-3-Clause
// Estimates poses of a rolling sphere from the samples of its IMU, which it reads line by line from standard input, as
// on a robot: tumble_online RADIUS_M [LEVER_X LEVER_Y LEVER_Z [GYRO_RANGE_RAD_S [ACCEL_RANGE_M_S2]]] From a socket: nc
// -l 5000 | tumble_online 0.145 Invalid lines are reported on standard error and skipped. Exit status: 0; 1 if no line
// was valid; 2 for wrong arguments.
#include <charconv>
#include <cstdio>
#include <cstring>
#include <optional>

#include "online.hpp"
#include "tumble/common/status.hpp"

namespace {

bool read(const char* text, double& value) {
  const char* end = text + std::strlen(text);
  const auto [last, error] = std::from_chars(text, end, value);
  return error == std::errc() && last == end;
}

bool read_arguments(int count, char** arguments, tumble::RollingParams& params) {
  if (count != 2 && count != 5 && count != 6 && count != 7) return false;
  double* const targets[] = {&params.radius_m,        &params.lever_arm_m.x(),  &params.lever_arm_m.y(),
                             &params.lever_arm_m.z(), &params.gyro_range_rad_s, &params.accel_range_m_s2};
  for (int k = 1; k < count; ++k) {
    if (!read(arguments[k], *targets[k - 1])) return false;
  }
  return true;
}

}  // namespace

int main(int count, char** arguments) {
  tumble::RollingParams params;
  if (!read_arguments(count, arguments, params)) {
    std::fputs("use: tumble_online RADIUS_M [LEVER_X LEVER_Y LEVER_Z [GYRO_RANGE_RAD_S [ACCEL_RANGE_M_S2]]]\n", stderr);
    return 2;
  }
  std::optional<online::Online> filter;
  try {
    filter.emplace(params);
  } catch (const tumble::InvalidParams& error) {
    std::fprintf(stderr, "tumble_online: %s\n", error.what());
    return 2;
  }
  static char in[1 << 12], out[1 << 12], line[online::Online::kLineMax];
  std::setvbuf(stdin, in, _IOFBF, sizeof in);
  std::setvbuf(stdout, out, _IOLBF, sizeof out);  // a pose is out before the next sample is waited for
  unsigned long long number = 0;
  while (std::fgets(line, sizeof line, stdin) != nullptr) {
    ++number;
    const std::string_view answer = filter->take(line);
    if (!filter->ok()) {
      std::fprintf(stderr, "line %llu: %.*s\n", number, static_cast<int>(answer.size()), answer.data());
    } else if (!answer.empty()) {
      std::printf("%.*s\n", static_cast<int>(answer.size()), answer.data());
    }
  }
  return filter->samples() > 0 ? 0 : 1;
}
