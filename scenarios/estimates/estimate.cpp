// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/estimates/estimate.hpp"

namespace tumble::scenarios {

const char* to_string(Kind kind) {
  switch (kind) {
    case Kind::rate:
      return "rate";
    case Kind::attitude:
      return "attitude";
    case Kind::position:
      return "position";
    case Kind::slam:
      return "slam";
  }
  return "unknown";
}

std::optional<Kind> kind_named(std::string_view name) {
  for (const Kind kind : kKinds) {
    if (name == to_string(kind)) return kind;
  }
  return std::nullopt;
}

std::string full_name(Kind kind, const std::string& method) {
  return std::string(to_string(kind)) + "/" + method;
}

const char* to_string(Frame frame) {
  switch (frame) {
    case Frame::imu:
      return "imu";
    case Frame::lidar:
      return "lidar";
    case Frame::body:
      return "body";
    case Frame::centre:
      return "centre";
  }
  return "unknown";
}

}  // namespace tumble::scenarios
