// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/beam_spread.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::sim {

namespace {

struct Share {
  float range_m, energy;
  int ray;
};

struct Echo {
  int first = 0, last = 0;
  float energy = 0.0f;
};

Echo strongest(const std::array<Share, kMaxBeamRays>& shares, int count, float echo_length_m) {
  Echo best, now;
  for (int i = 0; i < count; ++i) {
    if (i > now.first && shares[i].range_m - shares[i - 1].range_m > echo_length_m) now = {i, i, 0.0f};
    now.last = i + 1;
    now.energy += shares[i].energy;
    if (now.energy > best.energy) best = now;
  }
  return best;
}

}  // namespace

BeamSpread::BeamSpread(const Values& values) : echo_length_m_(static_cast<float>(values.at("echo_length_m"))) {
  const double rays = values.at("beam_rays");
  if (rays != std::floor(rays)) throw InvalidSituation("lidar: beam_rays must be a whole number");
  rays_ = static_cast<int>(rays);
  constexpr double kGoldenAngle_rad = 2.399963229728653;
  for (int k = 0; k < rays_; ++k) {
    const double radius = std::sqrt((k + 0.5) / rays_), angle = k * kGoldenAngle_rad;
    across_[k] = radius * std::cos(angle) * std::tan(0.5 * values.at("divergence_horizontal_rad"));
    up_[k] = radius * std::sin(angle) * std::tan(0.5 * values.at("divergence_vertical_rad"));
  }
}

[[gnu::target("avx2")]] void BeamSpread::bend(const ChannelFirings& axis, int k, ChannelFirings& firings) const {
  firings = axis;
  for (int s = 0; s < kLanes; ++s) {
    const double x = axis.direction_x[s], y = axis.direction_y[s], z = axis.direction_z[s];
    const double flat = std::sqrt(x * x + y * y), per = flat > 0.0 ? 1.0 / flat : 0.0;
    const double hx = flat > 0.0 ? -y * per : 1.0, hy = x * per;
    const double vx = -z * hy, vy = z * hx, vz = x * hy - y * hx;
    const double bx = x + across_[k] * hx + up_[k] * vx, by = y + across_[k] * hy + up_[k] * vy, bz = z + up_[k] * vz;
    const double scale = 1.0 / std::sqrt(bx * bx + by * by + bz * bz);
    firings.direction_x[s] = scale * bx;
    firings.direction_y[s] = scale * by;
    firings.direction_z[s] = scale * bz;
  }
}

void BeamSpread::merge(const std::array<RayPacket, kMaxBeamRays>& rays, Echoes& echoes) const {
  RayPacket& out = echoes.packet;
  out.count = rays[0].count;
  for (int s = 0; s < kLanes; ++s) {
    out.surface_id[s] = kNothing;
    out.range[s] = 1.0f;
    out.cosine[s] = out.reflectivity[s] = echoes.hit_x[s] = echoes.hit_y[s] = echoes.hit_z[s] = 0.0f;
    if (s >= out.count) continue;
    std::array<Share, kMaxBeamRays> shares;
    int count = 0;
    for (int k = 0; k < rays_; ++k) {
      if (rays[k].surface_id[s] == kNothing) continue;
      const float range = rays[k].range[s];
      shares[count++] = {range, rays[k].reflectivity[s] * rays[k].cosine[s] / (range * range), k};
    }
    std::sort(shares.begin(), shares.begin() + count, [](const Share& a, const Share& b) {
      return a.range_m < b.range_m || (a.range_m == b.range_m && a.ray < b.ray);
    });
    const Echo echo = strongest(shares, count, echo_length_m_);
    if (!(echo.energy > 0.0f)) continue;
    float moment = 0.0f, cosines = 0.0f, most = -1.0f;
    int strongest_ray = 0;
    for (int i = echo.first; i < echo.last; ++i) {
      moment += shares[i].energy * shares[i].range_m;
      cosines += shares[i].energy * rays[shares[i].ray].cosine[s];
      if (shares[i].energy > most) {
        most = shares[i].energy;
        strongest_ray = shares[i].ray;
      }
    }
    const RayPacket& ray = rays[strongest_ray];
    out.range[s] = moment / echo.energy;
    out.cosine[s] = cosines / echo.energy;
    out.reflectivity[s] = echo.energy / static_cast<float>(rays_) * out.range[s] * out.range[s] / out.cosine[s];
    out.surface_id[s] = ray.surface_id[s];
    echoes.hit_x[s] = ray.origin_x[s] + ray.range[s] * ray.direction_x[s];
    echoes.hit_y[s] = ray.origin_y[s] + ray.range[s] * ray.direction_y[s];
    echoes.hit_z[s] = ray.origin_z[s] + ray.range[s] * ray.direction_z[s];
  }
}

[[gnu::target("avx2")]] void set_hits(Echoes& echoes) {
  const RayPacket& p = echoes.packet;
  for (int s = 0; s < kLanes; ++s) {
    echoes.hit_x[s] = p.origin_x[s] + p.range[s] * p.direction_x[s];
    echoes.hit_y[s] = p.origin_y[s] + p.range[s] * p.direction_y[s];
    echoes.hit_z[s] = p.origin_z[s] + p.range[s] * p.direction_z[s];
  }
}

}  // namespace tumble::sim
