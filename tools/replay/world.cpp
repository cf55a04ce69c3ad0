// SPDX-License-Identifier: BSD-3-Clause
#include "tools/replay/parts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace tumble::tools {

namespace {

using Eigen::AlignedBox3f;
using Eigen::Vector3f;
using sim::MeshPart;

std::vector<int> kept_nodes(const std::vector<float>& positions, float low, float high, float coarser) {
  const auto away = [&](float node) { return std::max({0.0f, low - node, node - high}); };
  std::vector<int> kept = {0};
  const int last = static_cast<int>(positions.size()) - 1;
  for (int i = 1; i < last; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const float step = positions[at] - positions[static_cast<std::size_t>(kept.back())];
    const float cell = positions[at + 1] - positions[at];
    const float least = coarser * std::max(cell, 0.125f * away(positions[at])) - (coarser > 1.0f ? 0.0f : 0.5f * cell);
    if (step >= least) kept.push_back(i);
  }
  kept.push_back(last);
  return kept;
}

MeshPart thinned_field(const MeshPart& field, const AlignedBox3f& near, float coarser) {
  std::vector<float> x, y;
  for (int c = 0; c < field.columns; ++c) x.push_back(field.vertices_m[static_cast<std::size_t>(c)].x());
  for (int r = 0; r < field.rows; ++r) y.push_back(field.vertices_m[static_cast<std::size_t>(r * field.columns)].y());
  const std::vector<int> columns = kept_nodes(x, near.min().x(), near.max().x(), coarser);
  const std::vector<int> rows = kept_nodes(y, near.min().y(), near.max().y(), coarser);
  MeshPart out;
  out.rgba = field.rgba;
  out.rows = static_cast<int>(rows.size());
  out.columns = static_cast<int>(columns.size());
  for (const int r : rows) {
    for (const int c : columns)
      out.vertices_m.push_back(field.vertices_m[static_cast<std::size_t>(r * field.columns + c)]);
  }
  return out;
}

MeshPart fitting_field(const MeshPart& field, const AlignedBox3f& near, std::size_t most) {
  MeshPart out = thinned_field(field, near, 1.0f);
  for (float coarser = 1.5f; triangle_count(out) > most && coarser < 100.0f; coarser *= 1.5f)
    out = thinned_field(field, near, coarser);
  return out;
}

AlignedBox3f box_of(const MeshPart& part) {
  AlignedBox3f box;
  for (const Vector3f& vertex : part.vertices_m) box.extend(vertex);
  return box;
}

float prominence(const MeshPart& part, const AlignedBox3f& near) {
  const AlignedBox3f box = box_of(part);
  if (box.isEmpty()) return 0.0f;
  const float away = near.isEmpty() ? 0.0f : near.exteriorDistance(box);
  return box.diagonal().norm() / (1.0f + away);
}

bool is_field(const MeshPart& part) {
  return part.rows > 1 && part.columns > 1;
}

}  // namespace

std::size_t triangle_count(const MeshPart& part) {
  if (!is_field(part)) return part.triangles.size();
  return 2 * static_cast<std::size_t>(part.rows - 1) * static_cast<std::size_t>(part.columns - 1);
}

std::vector<MeshPart> thinned_world(std::vector<MeshPart> parts, const AlignedBox3f& near, std::size_t most,
                                    Shown& triangles) {
  triangles = {};
  std::size_t fields = 0;
  for (const MeshPart& part : parts) {
    triangles.of += triangle_count(part);
    if (is_field(part)) ++fields;
  }
  std::size_t left = most;
  for (MeshPart& part : parts) {
    if (!is_field(part)) continue;
    part = fitting_field(part, near, most * 3 / 4 / fields);
    left -= std::min(left, triangle_count(part));
  }
  std::vector<float> prominences;
  for (const MeshPart& part : parts) prominences.push_back(prominence(part, near));
  std::vector<std::size_t> order(parts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return prominences[a] > prominences[b]; });
  std::vector<bool> kept(parts.size(), false);
  for (const std::size_t i : order) {
    const std::size_t count = is_field(parts[i]) ? 0 : triangle_count(parts[i]);
    if (count > left) continue;
    left -= count;
    kept[i] = true;
  }
  std::vector<MeshPart> out;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!kept[i] || parts[i].vertices_m.empty()) continue;
    triangles.shown += triangle_count(parts[i]);
    out.push_back(std::move(parts[i]));
  }
  return out;
}

std::vector<MeshPart> plain_body(double sphere_radius_m) {
  MeshPart body;
  if (sphere_radius_m > 0.0) {
    constexpr int kAround = 16, kUp = 8;
    for (int ring = 0; ring <= kUp; ++ring) {
      const double latitude = std::numbers::pi * (static_cast<double>(ring) / kUp - 0.5);
      for (int i = 0; i < kAround; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kAround;
        body.vertices_m.push_back(
            (sphere_radius_m * Eigen::Vector3d(std::cos(latitude) * std::cos(angle),
                                               std::cos(latitude) * std::sin(angle), std::sin(latitude)))
                .cast<float>());
      }
    }
    for (std::uint32_t ring = 0; ring < kUp; ++ring) {
      for (std::uint32_t i = 0; i < kAround; ++i) {
        const std::uint32_t a = ring * kAround + i, b = ring * kAround + (i + 1) % kAround;
        body.triangles.push_back({a, b, b + kAround});
        body.triangles.push_back({a, b + kAround, a + kAround});
      }
    }
    return {body};
  }
  const Vector3f corners[] = {{-0.15f, -0.1f, -0.05f}, {0.1f, -0.1f, -0.05f},  {0.1f, 0.1f, -0.05f},
                              {-0.15f, 0.1f, -0.05f},  {-0.15f, -0.1f, 0.05f}, {0.1f, -0.1f, 0.05f},
                              {0.1f, 0.1f, 0.05f},     {-0.15f, 0.1f, 0.05f},  {0.18f, 0.0f, -0.05f},
                              {0.18f, 0.0f, 0.05f}};
  constexpr std::array<std::array<std::uint32_t, 3>, 16> kFaces = {{{0, 3, 2},
                                                                    {0, 2, 1},
                                                                    {1, 2, 8},
                                                                    {4, 5, 6},
                                                                    {4, 6, 7},
                                                                    {5, 9, 6},
                                                                    {0, 1, 5},
                                                                    {0, 5, 4},
                                                                    {1, 8, 9},
                                                                    {1, 9, 5},
                                                                    {8, 2, 6},
                                                                    {8, 6, 9},
                                                                    {2, 3, 7},
                                                                    {2, 7, 6},
                                                                    {3, 0, 4},
                                                                    {3, 4, 7}}};
  body.rgba = {0.75f, 0.77f, 0.8f, 1.0f};
  for (const auto& face : kFaces) {
    const auto first = static_cast<std::uint32_t>(body.vertices_m.size());
    for (const std::uint32_t corner : face) body.vertices_m.push_back(corners[corner]);
    body.triangles.push_back({first, first + 1, first + 2});
  }
  return {body};
}

}  // namespace tumble::tools
