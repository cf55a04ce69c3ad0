// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sim/render/renderer.hpp"

namespace tumble::tools {

/// Equal pictures give equal bytes.
class WebpAnimation {
 public:
  /// Throws std::invalid_argument unless width and height are 1 to 16383 pixels and `quality` is 0 (small file) to 100.
  WebpAnimation(int width, int height, float quality);
  ~WebpAnimation();
  WebpAnimation(WebpAnimation&&) noexcept;

  /// Throws std::invalid_argument if the size of the picture differs or the duration is below 1 ms, and
  /// std::runtime_error if compression fails.
  void add(const sim::Picture& picture, int duration_ms);

  /// Throws std::logic_error if the animation has no picture; no picture may follow.
  std::vector<std::uint8_t> bytes();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble::tools
