// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "tools/pictures/paths.hpp"
#include "tools/pictures/pictures.hpp"

/// A motion as a picture that moves: the camera goes with the robot, and leaves robots standing along its path.
namespace tumble::tools {

struct MovingOptions {
  int width = 640, height = 360;
  double frames_per_s = 20.0;
  double speed = 0.5;  ///< seconds of the motion in a second that one watches
  int strobe = 6;      ///< robots that stand where it came by, at equal steps of the path; 0: none
  float quality = 60.0f;
  std::function<void(std::size_t frames)> drawn;  ///< told how many frames are done after each; may be empty
};

/// The part of the moving span, `length_s` long, in which the body turns most; the whole of it where it is shorter.
Span liveliest_span(const sim::Truth& truth, double length_s);

/// Frames of a moving picture of that span.
std::size_t frame_count(const Span& span, const MovingOptions& options);

/// A WebP that plays the span for ever, a frame at each 1/frames_per_s. Needs the truth; throws scenarios::BadInput
/// without. The same scene gives the same bytes.
std::vector<std::uint8_t> moving_picture(const Scene& scene, const Span& span, const MovingOptions& options);

}  // namespace tumble::tools
