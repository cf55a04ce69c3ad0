// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "sim/engine/model.hpp"
#include "sim/render/renderer.hpp"

namespace tumble::sim {

/// SceneRenderer renders pictures of a world. Only one thread at a time may use a SceneRenderer, because an OSMesa
/// context belongs to one thread.
class SceneRenderer {
 public:
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
