// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "sim/engine/model.hpp"
#include "sim/render/renderer.hpp"

namespace tumble::sim {

/// Private to sim: pictures of a compiled world (OSMesa, MuJoCo's own renderer).
///
/// Threads: an OSMesa context is current to one thread at a time. The renderer makes its context current for each call
/// and lets go of it after, so that it may be used from any thread but by one at a time; several renderers may live in
/// one process. It looks up no display and needs none.
class SceneRenderer {
 public:
  /// Takes over the world; changes its colours of sky, light and shadow settings, which nothing else sees.
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
