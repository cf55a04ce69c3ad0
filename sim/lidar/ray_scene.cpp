// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/ray_scene.hpp"

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>
#include <vector>

#include "sim/lidar/nearest_hits.hpp"
#include "sim/lidar/shape_lanes.hpp"
#include "sim/lidar/triangle.hpp"

namespace tumble::sim {

namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

struct DeviceDeleter {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneDeleter {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using DevicePtr = std::unique_ptr<RTCDeviceTy, DeviceDeleter>;
using ScenePtr = std::unique_ptr<RTCSceneTy, SceneDeleter>;

/// Embree must use the same kernel on every CPU, because the results of different kernels differ in the last bits.
constexpr const char* kDevice =
    // The option "threads=1" would limit oneTBB in the whole process while the Embree device exists.
    "start_threads=0,set_affinity=0,isa=avx2,frequency_level=simd256,ignore_config_files=1";
constexpr int kKernelLanes = 8;
static_assert(kKernelLanes == kShapeLanes && NearestHits::kNone == RTC_INVALID_GEOMETRY_ID);
/// Embree computes approximate ranges, so the range to each face that Embree reports is computed again. Embree searches
/// faces along a ray up to kReach times the smallest range computed so far.
constexpr float kReach = 1.0f + 4e-6f;

struct MeshLabel {
  std::int32_t surface_id = kNothing;
  float reflectivity = 0.0f;
  bool as_quads = false;
  const float* vertices = nullptr;  ///< points into the buffers of Embree
  const std::uint32_t* faces = nullptr;

  Vector3f corner(std::uint32_t face, std::uint32_t i) const {
    return Eigen::Map<const Vector3f>(vertices + 3 * faces[(as_quads ? 4 : 3) * face + i]);
  }
};

struct CastContext {
  RTCIntersectContext embree;
  const std::vector<MeshLabel>* meshes;
  NearestHits nearest;
};

CastContext& cast_context(RTCIntersectContext* context) {
  return *reinterpret_cast<CastContext*>(context);
}

float searched_to(double range_m) {
  return static_cast<float>(range_m) * kReach;
}

/// Combines pairs of triangles (a, b, c) and (a, c, d), as in a height field, into quads (b, c, d, a). Embree cuts a
/// quad along the common edge of the two triangles. With quads instead of triangles, building the scene takes half of
/// the time, and casting rays takes 90 % of the time.
std::vector<std::array<std::uint32_t, 4>> paired(const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  std::vector<std::array<std::uint32_t, 4>> quads;
  if (triangles.size() % 2 != 0) return quads;
  quads.reserve(triangles.size() / 2);
  for (std::size_t i = 0; i < triangles.size(); i += 2) {
    const auto& first = triangles[i];
    const auto& second = triangles[i + 1];
    if (second[0] != first[0] || second[1] != first[2]) return {};
    quads.push_back({first[1], first[2], second[2], first[0]});
  }
  return quads;
}

void shape_bounds(const RTCBoundsFunctionArguments* args) {
  const Shape& shape = static_cast<const SceneShape*>(args->geometryUserPtr)[args->primID].shape;
  const Vector3d half = shape.R_FS.cwiseAbs() * half_extent(shape);
  const Vector3f margin = Vector3f::Constant(1e-5f) + 1e-6f * (shape.p_FS_m.cwiseAbs() + half).cast<float>();
  const Vector3f low = (shape.p_FS_m - half).cast<float>() - margin,
                 high = (shape.p_FS_m + half).cast<float>() + margin;
  *args->bounds_o = {low.x(), low.y(), low.z(), 0.0f, high.x(), high.y(), high.z(), 0.0f};
}

struct Ray {
  Vector3d origin, direction;
};

Ray ray_at(RTCRayN* rays, unsigned int count, unsigned int i) {
  return {Vector3d(RTCRayN_org_x(rays, count, i), RTCRayN_org_y(rays, count, i), RTCRayN_org_z(rays, count, i)),
          Vector3d(RTCRayN_dir_x(rays, count, i), RTCRayN_dir_y(rays, count, i), RTCRayN_dir_z(rays, count, i))};
}

double meet_face(const MeshLabel& mesh, unsigned int face, const Ray& ray, bool second_half, Vector3d& normal) {
  const auto corner = [&](std::uint32_t i) -> Vector3d { return mesh.corner(face, i).cast<double>() - ray.origin; };
  Vector3d a = corner(0), b = corner(1), c = corner(2);
  if (mesh.as_quads) {
    const Vector3d d = corner(3);
    const Vector3d across = b.cross(d);
    const bool beside_first = across.dot(a) >= 0.0, beside_second = across.dot(c) >= 0.0;
    const bool in_second =
        beside_first == beside_second ? second_half : (across.dot(ray.direction) >= 0.0) == beside_second;
    if (in_second)
      a = d;  // keeps the orientation of the surface
    else
      c = d;
  }
  normal = (b - a).cross(c - a);
  return normal.dot(a) / normal.dot(ray.direction);
}

void keep_nearest(const RTCFilterFunctionNArguments* args) {
  CastContext& cast = cast_context(args->context);
  for (unsigned int i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const unsigned int lane = RTCRayN_id(args->ray, args->N, i);
    const unsigned int geometry = RTCHitN_geomID(args->hit, args->N, i), face = RTCHitN_primID(args->hit, args->N, i);
    const bool second_half = RTCHitN_u(args->hit, args->N, i) + RTCHitN_v(args->hit, args->N, i) > 1.0f;
    Vector3d normal;
    const double range_m =
        meet_face((*cast.meshes)[geometry], face, ray_at(args->ray, args->N, i), second_half, normal);
    args->valid[i] = 0;
    if (!cast.nearest.is_replaced(lane, range_m, geometry, face)) continue;
    cast.nearest.replace(lane, range_m, normal.x(), normal.y(), normal.z(), geometry, face);
    RTCRayN_tfar(args->ray, args->N, i) = searched_to(range_m);
    args->valid[i] = -1;
  }
}

void intersect_shape(const RTCIntersectFunctionNArguments* args) {
  const Shape& shape = static_cast<const SceneShape*>(args->geometryUserPtr)[args->primID].shape;
  CastContext& cast = cast_context(args->context);
  auto& all = *reinterpret_cast<RTCRayHit8*>(args->rayhit);
  RTCRay8& rays = all.ray;
  ShapeHits hits;
  cast_rays(shape, {rays.org_x, rays.org_y, rays.org_z, rays.dir_x, rays.dir_y, rays.dir_z}, args->valid, hits);
  for (int i = 0; i < kShapeLanes; ++i) {
    const unsigned int lane = rays.id[i];
    if (args->valid[i] == 0 || !cast.nearest.is_replaced(lane, hits.range_m[i], args->geomID, args->primID)) continue;
    cast.nearest.replace(lane, hits.range_m[i], hits.normal_x[i], hits.normal_y[i], hits.normal_z[i], args->geomID,
                         args->primID);
    rays.tfar[i] = searched_to(hits.range_m[i]);
    all.hit.geomID[i] = args->geomID;
    all.hit.primID[i] = args->primID;
    all.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
}

bool approach_shape(RTCPointQueryFunctionArguments* args) {
  const auto* shapes = static_cast<const SceneShape*>(args->userPtr);
  const RTCPointQuery& q = *args->query;
  const auto distance = static_cast<float>(surface_distance(shapes[args->primID].shape, Vector3d(q.x, q.y, q.z)));
  if (!(distance < q.radius)) return false;
  args->query->radius = distance;
  return true;
}

}  // namespace

struct RayScene::Impl {
  DevicePtr device;
  ScenePtr scene;
  std::vector<SceneShape> bounded;  ///< indexed by Embree's primitive id
  std::vector<SceneShape> unbounded;
  std::vector<MeshLabel> meshes;  ///< indexed by Embree's geometry id
  unsigned int shape_geometry = RTC_INVALID_GEOMETRY_ID;

  void add_mesh(const SceneMesh& mesh);
  void add_shapes();
  void cast_planes(RayPacket& packet) const;
  void cast_lanes(const RayPacket& packet, int first, CastContext& cast) const;
  static bool approach(RTCPointQueryFunctionArguments* args);
};

void RayScene::Impl::add_mesh(const SceneMesh& part) {
  const std::vector<Vector3f>& corners = part.mesh.vertices_F_m;
  const std::vector<std::array<std::uint32_t, 4>> quads = paired(part.mesh.triangles);
  const bool as_quads = !quads.empty();
  const RTCGeometry geometry =
      rtcNewGeometry(device.get(), as_quads ? RTC_GEOMETRY_TYPE_QUAD : RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), corners.size()));
  const std::size_t sides = as_quads ? 4 : 3;
  auto* faces = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, as_quads ? RTC_FORMAT_UINT4 : RTC_FORMAT_UINT3,
                              sides * sizeof(std::uint32_t), as_quads ? quads.size() : part.mesh.triangles.size()));
  if (vertices == nullptr || faces == nullptr) throw std::bad_alloc();
  for (const Vector3f& v : corners) vertices = std::copy(v.data(), v.data() + 3, vertices);
  for (const auto& q : quads) faces = std::copy(q.begin(), q.end(), faces);
  if (!as_quads) {
    for (const auto& t : part.mesh.triangles) faces = std::copy(t.begin(), t.end(), faces);
  }
  rtcSetGeometryIntersectFilterFunction(geometry, keep_nearest);
  rtcCommitGeometry(geometry);
  const unsigned int id = rtcAttachGeometry(scene.get(), geometry);
  rtcReleaseGeometry(geometry);  // the scene keeps a reference
  meshes.resize(std::max<std::size_t>(meshes.size(), id + 1), MeshLabel{});
  meshes[id] = {part.surface_id, part.reflectivity, as_quads,
                static_cast<const float*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0)),
                static_cast<const std::uint32_t*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_INDEX, 0))};
}

void RayScene::Impl::add_shapes() {
  if (bounded.empty()) return;
  const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned int>(bounded.size()));
  rtcSetGeometryUserData(geometry, bounded.data());
  rtcSetGeometryBoundsFunction(
      geometry, [](const RTCBoundsFunctionArguments* args) { shape_bounds(args); }, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect_shape);
  rtcCommitGeometry(geometry);
  shape_geometry = rtcAttachGeometry(scene.get(), geometry);
  rtcReleaseGeometry(geometry);
}

RayScene::RayScene(const SceneGeometry& geometry) : impl_(std::make_unique<Impl>()) {
  impl_->device.reset(rtcNewDevice(kDevice));
  if (!impl_->device && rtcGetDeviceError(nullptr) == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  if (!impl_->device)
    throw std::runtime_error("lidar: the ray-tracing library Embree cannot start; the CPU must have AVX2 and FMA");
  impl_->scene.reset(rtcNewScene(impl_->device.get()));
  rtcSetSceneFlags(impl_->scene.get(), RTC_SCENE_FLAG_ROBUST);  // no gaps between triangles
  for (const SceneShape& part : geometry.shapes) {
    (half_extent(part.shape).allFinite() ? impl_->bounded : impl_->unbounded).push_back(part);
  }
  for (const SceneMesh& part : geometry.meshes) impl_->add_mesh(part);
  impl_->add_shapes();
  // The scene is built in an arena with one thread, because building must not use threads that the caller did not
  // provide.
  tbb::task_arena(1).execute([this] { rtcCommitScene(impl_->scene.get()); });
  const RTCError error = rtcGetDeviceError(impl_->device.get());
  if (error != RTC_ERROR_NONE) throw std::runtime_error("lidar: Embree error " + std::to_string(error));
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

bool RayScene::empty() const {
  return impl_->bounded.empty() && impl_->unbounded.empty() && impl_->meshes.empty();
}

void RayScene::Impl::cast_planes(RayPacket& packet) const {
  for (const SceneShape& part : unbounded) {
    for (int i = 0; i < packet.count; ++i) {
      const Vector3d origin(packet.origin_x[i], packet.origin_y[i], packet.origin_z[i]);
      const Vector3d direction(packet.direction_x[i], packet.direction_y[i], packet.direction_z[i]);
      Vector3d normal;
      const auto range = static_cast<float>(cast_ray(part.shape, origin, direction, normal));
      if (!(range < packet.range[i])) continue;
      packet.range[i] = range;
      packet.surface_id[i] = part.surface_id;
      packet.reflectivity[i] = part.reflectivity;
      packet.cosine[i] = static_cast<float>(std::abs(normal.dot(direction)));
    }
  }
}

void RayScene::Impl::cast_lanes(const RayPacket& packet, int first, CastContext& cast) const {
  RTCRayHit8 rays;
  alignas(32) int valid[kKernelLanes];
  for (int i = 0; i < kKernelLanes; ++i) {
    const bool used = first + i < packet.count;
    const int lane = used ? first + i : first;
    valid[i] = used ? -1 : 0;
    rays.ray.org_x[i] = packet.origin_x[lane];
    rays.ray.org_y[i] = packet.origin_y[lane];
    rays.ray.org_z[i] = packet.origin_z[lane];
    rays.ray.dir_x[i] = packet.direction_x[lane];
    rays.ray.dir_y[i] = packet.direction_y[lane];
    rays.ray.dir_z[i] = packet.direction_z[lane];
    rays.ray.tnear[i] = 0.0f;
    rays.ray.tfar[i] = used ? searched_to(packet.range[lane]) : -1.0f;
    rays.ray.time[i] = 0.0f;
    rays.ray.mask[i] = ~0u;
    rays.ray.id[i] = static_cast<unsigned int>(lane);
    rays.ray.flags[i] = 0;
    rays.hit.Ng_x[i] = rays.hit.Ng_y[i] = rays.hit.Ng_z[i] = rays.hit.u[i] = rays.hit.v[i] = 0.0f;
    rays.hit.primID[i] = rays.hit.geomID[i] = rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  rtcIntersect8(valid, scene.get(), &cast.embree, &rays);
}

void RayScene::cast(RayPacket& packet) const {
  impl_->cast_planes(packet);
  if (impl_->bounded.empty() && impl_->meshes.empty()) return;
  CastContext cast{{}, &impl_->meshes, NearestHits(packet)};
  rtcInitIntersectContext(&cast.embree);
  cast.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  for (int first = 0; first < packet.count; first += kKernelLanes) impl_->cast_lanes(packet, first, cast);
  cast.nearest.write(packet);
  for (int i = 0; i < packet.count; ++i) {
    const unsigned int geometry = cast.nearest.geometry(i);
    if (geometry == NearestHits::kNone) continue;
    if (geometry == impl_->shape_geometry) {
      const SceneShape& part = impl_->bounded[cast.nearest.primitive(i)];
      packet.surface_id[i] = part.surface_id;
      packet.reflectivity[i] = part.reflectivity;
    } else {
      const MeshLabel& label = impl_->meshes[geometry];
      packet.surface_id[i] = label.surface_id;
      packet.reflectivity[i] = label.reflectivity;
    }
  }
}

bool RayScene::Impl::approach(RTCPointQueryFunctionArguments* args) {
  auto& impl = *static_cast<Impl*>(args->userPtr);
  RTCPointQuery& q = *args->query;
  if (args->geomID == impl.shape_geometry) {
    args->userPtr = impl.bounded.data();
    const bool nearer = approach_shape(args);
    args->userPtr = &impl;
    return nearer;
  }
  const MeshLabel& mesh = impl.meshes[args->geomID];
  const auto corner = [&](std::uint32_t i) { return mesh.corner(args->primID, i); };
  const Vector3f point(q.x, q.y, q.z);
  float distance;
  if (mesh.as_quads) {
    distance = std::min(triangle_distance(corner(3), corner(0), corner(1), point),
                        triangle_distance(corner(3), corner(1), corner(2), point));
  } else {
    distance = triangle_distance(corner(0), corner(1), corner(2), point);
  }
  if (!(distance < q.radius)) return false;
  q.radius = distance;
  return true;
}

float RayScene::distance(const Vector3f& point_m, float limit_m) const {
  double nearest = limit_m;
  for (const SceneShape& part : impl_->unbounded) {
    nearest = std::min(nearest, surface_distance(part.shape, point_m.cast<double>()));
  }
  RTCPointQuery query{point_m.x(), point_m.y(), point_m.z(), 0.0f, static_cast<float>(nearest)};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(impl_->scene.get(), &query, &context, &Impl::approach, impl_.get());
  return query.radius;
}

}  // namespace tumble::sim
