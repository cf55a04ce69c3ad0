// SPDX-License-Identifier: BSD-3-Clause
#include "sim/render/renderer.hpp"

#include "sim/compose.hpp"
#include "sim/render/scene_renderer.hpp"

namespace tumble::sim {

struct Renderer::Impl {
  SceneRenderer scene;
};

Renderer::Renderer(const Situation& situation, const std::filesystem::path& models)
    : impl_(new Impl{SceneRenderer(engine::compose(situation, models))}) {}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Picture Renderer::draw(const View& view) {
  return impl_->scene.draw(view);
}

}  // namespace tumble::sim
