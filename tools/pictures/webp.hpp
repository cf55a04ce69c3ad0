// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sim/render/renderer.hpp"

namespace tumble::tools {

class WebpAnimation {
 public:
  /// Throws std::invalid_argument unless width and height are 1 to 16383 pixels and `quality` is 0 (small file) to 100.
  WebpAnimation(int width, int height, float quality);
  ~WebpAnimation();
  WebpAnimation(WebpAnimation&&) noexcept;

  void add(const sim::Picture& picture, int duration_ms);

  std::vector<std::uint8_t> bytes();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble::tools
