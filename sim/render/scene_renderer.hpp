// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "sim/engine/model.hpp"
#include "sim/render/renderer.hpp"

namespace tumble::sim {

/// SceneRenderer renders pictures of a compiled world (OSMesa, MuJoCo's renderer), without a display. An OSMesa context
/// is current in one thread at a time. The renderer makes its context current during each call, so any thread may use
/// it, but only one thread at a time. Several renderers may exist in one process.
class SceneRenderer {
 public:
  /// Takes ownership of the world, and changes its settings of sky, light and shadow.
  SceneRenderer(engine::World world, int shadow_pixels);
  ~SceneRenderer();
  SceneRenderer(const SceneRenderer&) = delete;
  SceneRenderer& operator=(const SceneRenderer&) = delete;

  Picture draw(const View& view);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble::sim
