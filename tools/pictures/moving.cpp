// SPDX-License-Identifier: BSD-3-Clause
#include "tools/pictures/moving.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/errors.hpp"
#include "tools/pictures/pictures.hpp"
#include "tools/pictures/webp.hpp"

namespace tumble::tools {

namespace {

constexpr double kFollow_s = 0.4;
constexpr int kFollowSamples = 9;
constexpr int kPause_ms = 700;

double step_ns(const MovingOptions& options) {
  return 1e9 * options.speed / options.frames_per_s;
}

Eigen::Vector3d followed(const scenarios::TruthTrack& track, std::int64_t time_ns) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < kFollowSamples; ++i) {
    const double away_s = kFollow_s * (2.0 * i / (kFollowSamples - 1) - 1.0);
    sum += robot_pose(track, std::clamp<std::int64_t>(time_ns + std::llround(1e9 * away_s), 0, track.last_ns()))
               .translation();
  }
  return sum / kFollowSamples;
}

}  // namespace

Span liveliest_span(const sim::Truth& truth, double length_s) {
  const Span whole = moving_span(truth, 0.1);
  const auto begin = static_cast<std::size_t>(whole.begin_ns / truth.period_ns);
  const auto end = static_cast<std::size_t>(whole.end_ns / truth.period_ns);
  const auto length =
      static_cast<std::size_t>(std::max(1.0, std::round(1e9 * length_s / static_cast<double>(truth.period_ns))));
  if (begin + length >= end) return whole;
  double turned = 0.0, most = -1.0;
  std::size_t from = begin;
  for (std::size_t k = begin; k < end; ++k) {
    turned += truth.w_WB_B_rad_s[k].norm();
    if (k < begin + length) continue;
    turned -= truth.w_WB_B_rad_s[k - length].norm();
    if (turned <= most) continue;
    most = turned;
    from = k - length + 1;
  }
  const auto at = [&](std::size_t k) { return static_cast<std::int64_t>(k) * truth.period_ns; };
  return {at(from), at(from + length)};
}

std::size_t frame_count(const Span& span, const MovingOptions& options) {
  return 1 + static_cast<std::size_t>(std::floor(static_cast<double>(span.end_ns - span.begin_ns) / step_ns(options)));
}

std::vector<std::uint8_t> moving_picture(const Scene& scene, const Span& span, const MovingOptions& options) {
  if (scene.truth == nullptr || scene.truth->p_WB_m.empty())
    throw scenarios::BadInput("an animation needs a recording with truth, which gives the position of the robot");
  const scenarios::TruthTrack track(*scene.truth, scenarios::Frame::body);
  const std::vector<std::int64_t> stands =
      options.strobe > 0 ? instants_along(*scene.truth, options.strobe) : std::vector<std::int64_t>{};
  sim::Renderer renderer(*scene.built, 1024);
  sim::View view;
  view.width = options.width;
  view.height = options.height;
  view.paths = drawn_paths(scene);
  view.azimuth_rad = azimuth_across_rad(*scene.truth);
  view.distance_m = is_sphere(scene) ? 10.0 * scene.sensors->sphere_radius_m : 4.0;
  WebpAnimation animation(options.width, options.height, options.quality);
  const int frame_ms = std::max(1, static_cast<int>(std::lround(1e3 / options.frames_per_s)));
  const std::size_t frames = frame_count(span, options);
  for (std::size_t i = 0; i < frames; ++i) {
    const std::int64_t time_ns = span.begin_ns + std::llround(static_cast<double>(i) * step_ns(options));
    view.robots_T_WB = {robot_pose(track, time_ns)};
    for (const std::int64_t stood_ns : stands) {
      if (stood_ns < time_ns) view.robots_T_WB.push_back(robot_pose(track, stood_ns));
    }
    view.look_at_W_m = followed(track, time_ns);
    animation.add(renderer.draw(view), i + 1 < frames ? frame_ms : frame_ms + kPause_ms);
    if (options.drawn) options.drawn(i + 1);
  }
  return animation.bytes();
}

}  // namespace tumble::tools
