// SPDX-License-Identifier: BSD-3-Clause
#include "sim/render/renderer.hpp"

#include "sim/engine/model.hpp"
#include "sim/render/scene_renderer.hpp"

namespace tumble::sim {

struct Renderer::Impl {
  SceneRenderer scene;
};

Renderer::Renderer(const BuiltSituation& built, int shadow_pixels)
    : impl_(new Impl{SceneRenderer(engine::copy_of(built.world()), shadow_pixels)}) {}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Picture Renderer::draw(const View& view) {
  return impl_->scene.draw(view);
}

}  // namespace tumble::sim
