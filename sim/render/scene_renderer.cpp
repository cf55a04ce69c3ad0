// SPDX-License-Identifier: BSD-3-Clause
#include "sim/render/scene_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/engine/jointed.hpp"
#include "sim/render/decoration.hpp"
#include "sim/render/framing.hpp"
#include "sim/render/osmesa.hpp"

namespace tumble::sim {

namespace {

constexpr double kRadPerDegree = 0.017453292519943295;
constexpr int kLargestSide = 4096;
constexpr int kOversampling = 2;  // averaged, for smooth edges

struct ContextDeleter {
  void operator()(OSMesaContext context) const { osmesa().destroy_context(context); }
};
using ContextPtr = std::unique_ptr<osmesa_context, ContextDeleter>;

class Current {
 public:
  explicit Current(OSMesaContext context) {
    if (context == nullptr || osmesa().make_current(context, pixels_, GL_UNSIGNED_BYTE, kSide, kSide) != GL_TRUE) {
      throw std::runtime_error("render: OSMesa cannot create a rendering context");
    }
  }
  ~Current() { osmesa().make_current(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }
  Current(const Current&) = delete;
  Current& operator=(const Current&) = delete;

 private:
  static constexpr int kSide = 16;
  unsigned char pixels_[4 * kSide * kSide];
};

class Scene {
 public:
  Scene(const mjModel& model, int geoms) {
    mjv_defaultScene(&scene_);
    mjv_makeScene(&model, &scene_, geoms);
  }
  ~Scene() { mjv_freeScene(&scene_); }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  mjvScene& get() { return scene_; }

 private:
  mjvScene scene_;
};

Picture averaged(const std::vector<std::uint8_t>& large, int width, int height) {
  Picture picture{width, height,
                  std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))};
  const std::size_t stride = 3 * static_cast<std::size_t>(width) * kOversampling;
  auto out = picture.rgb.begin();
  for (int row = height - 1; row >= 0; --row) {
    for (int column = 0; column < width; ++column) {
      for (int c = 0; c < 3; ++c) {
        int sum = 0;
        for (int dy = 0; dy < kOversampling; ++dy) {
          const std::size_t line = static_cast<std::size_t>(row * kOversampling + dy) * stride;
          for (int dx = 0; dx < kOversampling; ++dx) {
            sum +=
                large[line + 3 * static_cast<std::size_t>(column * kOversampling + dx) + static_cast<std::size_t>(c)];
          }
        }
        *out++ = static_cast<std::uint8_t>((sum + kOversampling * kOversampling / 2) / (kOversampling * kOversampling));
      }
    }
  }
  return picture;
}

void set_look(mjModel& model, int shadow_pixels) {
  model.vis.quality.shadowsize = shadow_pixels;
  model.vis.quality.offsamples = 0;
  model.vis.quality.numslices = 24;
  model.vis.quality.numstacks = 14;
  for (int c = 0; c < 3; ++c) {
    model.vis.headlight.ambient[c] = 0.28f;
    model.vis.headlight.diffuse[c] = 0.30f;
    model.vis.headlight.specular[c] = 0.0f;
  }
}

void aim_sun(const Framing& framing, mjvScene& scene, mjrContext& engine) {
  const double reach_m = 2.0 + framing.distance_m;
  engine.shadowClip = static_cast<float>(reach_m);
  for (int i = 0; i < scene.nlight; ++i) {
    mjvLight& light = scene.lights[i];
    if (light.headlight || light.type != mjLIGHT_DIRECTIONAL) continue;
    for (int axis = 0; axis < 3; ++axis) {
      light.pos[axis] = static_cast<float>(framing.look_at_W_m[axis] - reach_m * light.dir[axis]);
      light.ambient[axis] = 0.1f;
      light.diffuse[axis] = 0.7f;
      light.specular[axis] = 0.1f;
    }
  }
}

}  // namespace

struct SceneRenderer::Impl {
  engine::World world;
  engine::DataPtr data;
  ContextPtr context;
  mjrContext engine_context;
  bool has_engine_context = false;

  ~Impl();
  void add_robots(const View& view, const mjvOption& option, mjvScene& scene);
  double robot_radius_m() const;
};

SceneRenderer::Impl::~Impl() {
  if (!has_engine_context) return;
  unsigned char pixel[4];
  if (osmesa().make_current(context.get(), pixel, GL_UNSIGNED_BYTE, 1, 1) != GL_TRUE) return;
  mjr_freeContext(&engine_context);
  osmesa().make_current(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0);
}

SceneRenderer::SceneRenderer(engine::World world, int shadow_pixels) : impl_(std::make_unique<Impl>()) {
  impl_->world = std::move(world);
  mjModel& model = *impl_->world.model;
  set_look(model, shadow_pixels);
  impl_->data.reset(mj_makeData(&model));
  impl_->context.reset(osmesa().create_context(OSMESA_RGBA, 24, 8, 8, nullptr));
  const Current current(impl_->context.get());
  mjr_defaultContext(&impl_->engine_context);
  mjr_makeContext(&model, &impl_->engine_context, mjFONTSCALE_100);
  impl_->has_engine_context = true;
  if (impl_->engine_context.offFBO == 0) throw std::runtime_error("render: OSMesa cannot create a frame buffer");
}

SceneRenderer::~SceneRenderer() = default;

double SceneRenderer::Impl::robot_radius_m() const {
  double radius_m = 0.1;
  const mjModel& model = *world.model;
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (!world.free && model.body_rootid[model.geom_bodyid[geom]] == model.body_rootid[world.robot_body]) {
      const Eigen::Map<const Eigen::Vector3d> p_W(data->geom_xpos + 3 * geom), p_WB(data->xpos + 3 * world.robot_body);
      radius_m = std::max(radius_m, (p_W - p_WB).norm() + model.geom_rbound[geom]);
    }
    if (model.geom_bodyid[geom] != world.robot_body) continue;
    const mjtNum* p = model.geom_pos + 3 * geom;
    radius_m = std::max(radius_m, std::hypot(p[0], p[1], p[2]) + model.geom_rbound[geom]);
  }
  return radius_m;
}

void SceneRenderer::Impl::add_robots(const View& view, const mjvOption& option, mjvScene& scene) {
  const mjModel& model = *world.model;
  if (world.robot_body < 0) return;
  if (!world.free) {
    for (const Eigen::Isometry3d& T_WB : view.robots_T_WB) {
      engine::reach(world, T_WB, *data);
      mjv_addGeoms(&model, data.get(), &option, nullptr, mjCAT_DYNAMIC, &scene);
    }
    return;
  }
  const int joint = model.body_jntadr[world.robot_body];
  if (joint < 0 || model.jnt_type[joint] != mjJNT_FREE) return;
  mjtNum* qpos = data->qpos + model.jnt_qposadr[joint];
  for (const Eigen::Isometry3d& T_WB : view.robots_T_WB) {
    const Eigen::Quaterniond q_WB(T_WB.linear());
    std::copy_n(T_WB.translation().data(), 3, qpos);
    const double wxyz[4] = {q_WB.w(), q_WB.x(), q_WB.y(), q_WB.z()};
    std::copy_n(wxyz, 4, qpos + 3);
    mj_kinematics(&model, data.get());
    mjv_addGeoms(&model, data.get(), &option, nullptr, mjCAT_DYNAMIC, &scene);
  }
}

Picture SceneRenderer::draw(const View& view) {
  if (view.width < 1 || view.height < 1 || view.width > kLargestSide || view.height > kLargestSide) {
    throw std::invalid_argument("render: width and height of a picture must be 1 to 4096 pixels");
  }
  const mjModel& model = *impl_->world.model;
  mj_resetData(&model, impl_->data.get());
  mj_kinematics(&model, impl_->data.get());
  mj_comPos(&model, impl_->data.get());
  mj_camlight(&model, impl_->data.get());

  const Framing framing = frame(view, impl_->robot_radius_m(), model.vis.global.fovy * kRadPerDegree);
  mjvCamera camera;
  mjv_defaultCamera(&camera);
  camera.type = mjCAMERA_FREE;
  std::copy_n(framing.look_at_W_m.data(), 3, camera.lookat);
  camera.distance = framing.distance_m;
  camera.azimuth = view.azimuth_rad / kRadPerDegree;
  camera.elevation = view.elevation_rad / kRadPerDegree;

  mjvOption option;
  mjv_defaultOption(&option);
  std::fill(std::begin(option.sitegroup), std::end(option.sitegroup), mjtByte{0});

  const int geoms =
      model.ngeom * static_cast<int>(view.robots_T_WB.size() + 1) + decoration_size(impl_->world, view) + 100;
  Scene holder(model, geoms);
  mjvScene& scene = holder.get();
  mjv_updateScene(&model, impl_->data.get(), &option, nullptr, &camera, mjCAT_STATIC, &scene);
  add_grid(impl_->world, *impl_->data, scene);
  add_paths(view, scene);
  add_points(view, scene);
  impl_->add_robots(view, option, scene);
  scene.flags[mjRND_SHADOW] = 1;
  scene.flags[mjRND_REFLECTION] = 0;

  const Current current(impl_->context.get());
  mjrContext& engine = impl_->engine_context;
  aim_sun(framing, scene, engine);
  const mjrRect area = {0, 0, view.width * kOversampling, view.height * kOversampling};
  if (engine.offWidth != area.width || engine.offHeight != area.height)
    mjr_resizeOffscreen(area.width, area.height, &engine);
  mjr_setBuffer(mjFB_OFFSCREEN, &engine);
  if (engine.currentBuffer != mjFB_OFFSCREEN)
    throw std::runtime_error("render: OpenGL cannot create the off-screen buffer");
  mjr_render(area, &scene, &engine);
  add_legend(view, area, engine);
  std::vector<std::uint8_t> large(3 * static_cast<std::size_t>(area.width) * static_cast<std::size_t>(area.height));
  mjr_readPixels(large.data(), nullptr, area, &engine);
  return averaged(large, view.width, view.height);
}

}  // namespace tumble::sim
