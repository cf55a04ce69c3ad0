// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sim/render/renderer.hpp"

namespace tumble::tools {

/// Pictures one after the other, for ever, as a WebP file (libwebp, lossy). The same pictures give the same bytes.
class WebpAnimation {
 public:
  /// Pixels of each picture, from 1 to 16383; `quality` from 0 (small) to 100. Throws std::invalid_argument beyond
  /// these.
  WebpAnimation(int width, int height, float quality);
  ~WebpAnimation();
  WebpAnimation(WebpAnimation&&) noexcept;

  /// Shown for `duration_ms`. Throws std::invalid_argument on another size or a duration below 1, std::runtime_error
  /// when it cannot be compressed.
  void add(const sim::Picture& picture, int duration_ms);

  /// The file. Throws std::logic_error without a picture; nothing is to be added after it.
  std::vector<std::uint8_t> bytes();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble::tools
