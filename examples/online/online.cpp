// SPDX-License-Identifier: BSD-3-Clause
#include "online.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <system_error>

namespace online {

namespace {

/// Parses the next number of `rest` and removes it from `rest`; returns false if no number remains.
template <typename Number>
bool next_number(std::string_view& rest, Number& value) {
  const std::size_t begin = rest.find_first_not_of(" \t,");
  if (begin == std::string_view::npos) return false;
  rest.remove_prefix(begin);
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (error != std::errc()) return false;
  rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
  return rest.empty() || rest.front() == ' ' || rest.front() == '\t' || rest.front() == ',';
}

const char* name(tumble::ContactMode mode) {
  switch (mode) {
    case tumble::ContactMode::grip:
      return "grip";
    case tumble::ContactMode::slip:
      return "slip";
    case tumble::ContactMode::bump:
      return "bump";
    case tumble::ContactMode::incline:
      return "incline";
    case tumble::ContactMode::uneven:
      return "rough";
  }
  return "?";
}

}  // namespace

Online::Online(const tumble::RollingParams& params)
    : filter_(params), state_(std::make_unique<tumble::RollingFilter::State>()) {}

std::string_view Online::take(std::string_view line) {
  ok_ = true;
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
  if (line.empty() || line.front() == '#') return {};
  tumble::ImuSample sample;
  if (!next_number(line, sample.time_ns)) return trouble("time_ns: not a whole number");
  for (int axis = 0; axis < 3; ++axis) {
    if (!next_number(line, sample.angular_velocity_rad_s[axis]))
      return trouble("angular velocity: three numbers needed");
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (!next_number(line, sample.specific_force_m_s2[axis])) return trouble("specific force: three numbers needed");
  }
  if (line.find_first_not_of(" \t,") != std::string_view::npos) return trouble("more than seven numbers");
  const tumble::Status status = filter_.step(sample, *state_);
  if (!status.ok()) {
    ok_ = false;
    const int length = std::snprintf(text_, kLineMax, "%s: %s is %g, bound %g", tumble::to_string(status.error_code),
                                     status.field, status.value, status.bound);
    return {text_, std::min(static_cast<std::size_t>(std::max(length, 0)), kLineMax - 1)};
  }
  ++samples_;
  return pose();
}

std::string_view Online::pose() {
  const tumble::RollingFilter::State& s = *state_;
  const double sigma_m = std::sqrt(s.position_covariance_m2.topLeftCorner<2, 2>().trace());
  const int length = std::snprintf(text_, kLineMax, "%lld %.6f %.6f %.6f %.9f %.9f %.9f %.9f %s %.6f%s",
                                   static_cast<long long>(s.last_time_ns), s.sphere_centre_W_m.x(),
                                   s.sphere_centre_W_m.y(), s.sphere_centre_W_m.z(), s.q_WI.x(), s.q_WI.y(), s.q_WI.z(),
                                   s.q_WI.w(), name(s.mode), sigma_m, s.position_uncertain ? " uncertain" : "");
  return {text_, std::min(static_cast<std::size_t>(std::max(length, 0)), kLineMax - 1)};
}

std::string_view Online::trouble(std::string_view what) {
  ok_ = false;
  const std::size_t length = what.copy(text_, kLineMax);
  return {text_, length};
}

}  // namespace online
