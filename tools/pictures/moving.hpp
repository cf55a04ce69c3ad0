// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "tools/pictures/paths.hpp"
#include "tools/pictures/pictures.hpp"

namespace tumble::tools {

struct MovingOptions {
  int width = 640, height = 360;
  double frames_per_s = 20.0;
  double speed = 0.5;  ///< motion time per playback time
  int strobe = 6;      ///< robots along the path
  float quality = 60.0f;
  std::function<void(std::size_t frames)> drawn;  ///< called after each frame
};

Span liveliest_span(const sim::Truth& truth, double length_s);

std::size_t frame_count(const Span& span, const MovingOptions& options);

std::vector<std::uint8_t> moving_picture(const Scene& scene, const Span& span, const MovingOptions& options);

}  // namespace tumble::tools
