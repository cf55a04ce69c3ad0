// SPDX-License-Identifier: BSD-3-Clause
#include "tools/replay/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "scenarios/errors.hpp"
#include "tools/pictures/colours.hpp"
#include "tools/pictures/paths.hpp"
#include "tools/replay/parts.hpp"

namespace tumble::tools {

namespace {

using Eigen::Isometry3d;

constexpr std::int64_t kStep_ns = 2'000'000;              ///< error at 30 m: 1 cm
constexpr std::size_t kTracksShare = 2, kStripShare = 8;  ///< limits: 1/2 and 1/8
constexpr std::size_t kPoseBytes = 20, kSampleBytes = 11, kRateBytes = 6, kPointBytes = 10;
constexpr float kAround_m = 2.5f;  ///< full ground resolution near the path

void require_parallel(const sim::Sensors& sensors) {
  for (const sim::LidarRecord& lidar : sensors.lidars) {
    if (lidar.offset_ns.size() != lidar.position_L_m.size())
      throw scenarios::BadInput(
          fmt::format("replay: lidar '{}' has {} points and {} time stamps; the numbers must be equal", lidar.name,
                      lidar.position_L_m.size(), lidar.offset_ns.size()));
  }
}

std::int64_t last_instant(const sim::Sensors& sensors, const sim::Truth* truth, const std::vector<Motion>& motions) {
  std::int64_t end_ns = 0;
  for (const sim::ImuRecord& imu : sensors.imus) {
    if (!imu.time_ns.empty()) end_ns = std::max(end_ns, imu.time_ns.back());
  }
  for (const sim::LidarRecord& lidar : sensors.lidars) {
    if (!lidar.sweep_start_ns.empty()) end_ns = std::max(end_ns, lidar.sweep_start_ns.back() + lidar.sweep_period_ns);
  }
  if (truth != nullptr && !truth->p_WB_m.empty())
    end_ns = std::max(end_ns, static_cast<std::int64_t>(truth->p_WB_m.size() - 1) * truth->period_ns);
  for (const Motion& motion : motions) {
    if (end_ns == 0 && !motion.empty()) end_ns = motion.end_ns();  // the recording contains only poses
  }
  return end_ns;
}

ReplayTrack sampled(const Motion& motion, std::int64_t end_ns, std::int64_t step_ns) {
  ReplayTrack track;
  if (motion.empty()) return track;
  for (std::int64_t t = 0; t <= end_ns; t += step_ns) {
    const std::optional<Isometry3d> T_WB = motion.at(t);
    track.p_WB_m.push_back(T_WB ? Eigen::Vector3d(T_WB->translation())
                                : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
    track.q_WB.push_back(T_WB ? Eigen::Quaterniond(T_WB->linear()) : Eigen::Quaterniond::Identity());
  }
  return track;
}

void find_motion(const ReplayInput& input, Replay& replay) {
  replay.to_ns = replay.end_ns;
  if (input.truth != nullptr && !input.truth->p_WB_m.empty() && input.truth->period_ns > 0) {
    const Span span = moving_span(*input.truth, 0.0);
    replay.from_ns = span.begin_ns;
    replay.to_ns = span.end_ns;
    return;
  }
  constexpr float kTurns_rad_s = 0.35f;
  bool found = false;
  for (std::size_t k = 0; k < replay.strip.time_ns.size(); ++k) {
    if (!(replay.strip.gyro_rad_s[k].norm() > kTurns_rad_s)) continue;
    if (!found) replay.from_ns = std::max<std::int64_t>(0, replay.strip.time_ns[k]);
    replay.to_ns = replay.strip.time_ns[k];
    found = true;
  }
}

bool has_path(const ReplayEstimate& given) {
  return !given.estimate->poses.empty();
}

std::vector<ReplayActor> actors_of(const ReplayInput& input) {
  std::vector<ReplayActor> actors;
  if (input.truth != nullptr) {
    ReplayActor truth;
    truth.name = "truth";
    truth.colour = truth_colour().hex;
    truth.is_truth = true;
    truth.T_BB_given = true_from_given_body(*input.sensors, *input.truth);
    actors.push_back(std::move(truth));
  }
  const auto with_path = static_cast<std::size_t>(std::ranges::count_if(input.estimates, has_path));
  std::size_t paths = 0, other = with_path;
  for (const ReplayEstimate& given : input.estimates) {
    ReplayActor actor;
    actor.name = given.name;
    actor.colour = method_colour(has_path(given) ? paths++ : other++).hex;
    actors.push_back(std::move(actor));
  }
  return actors;
}

std::vector<Motion> motions_of(const ReplayInput& input, std::int64_t step_ns) {
  std::vector<Motion> motions;
  if (input.truth != nullptr) motions.push_back(true_motion(*input.truth, step_ns));
  Motion reference = motions.empty() ? Motion() : motions.front();
  for (const ReplayEstimate& given : input.estimates) {
    motions.push_back(estimated_motion(*given.estimate, *input.sensors, input.truth, reference));
    if (reference.empty()) reference = motions.back();
  }
  if (reference.empty())
    throw scenarios::BadInput(
        "there is no path to show: give a recording whose truth has positions, or an estimate with poses");
  return motions;
}

double radius_of(const std::vector<sim::MeshPart>& parts) {
  float radius_m = 0.0f;
  for (const sim::MeshPart& part : parts) {
    for (const Eigen::Vector3f& vertex : part.vertices_m) radius_m = std::max(radius_m, vertex.norm());
  }
  return radius_m;
}

Eigen::AlignedBox3f surroundings(const std::vector<ReplayActor>& actors) {
  Eigen::AlignedBox3f box;
  for (const ReplayActor& actor : actors) {
    for (const Eigen::Vector3d& p : actor.track.p_WB_m) {
      if (p.allFinite()) box.extend(p.cast<float>());
    }
    if (!box.isEmpty()) break;
  }
  box.extend((box.min() - Eigen::Vector3f::Constant(kAround_m)).eval());
  box.extend((box.max() + Eigen::Vector3f::Constant(kAround_m)).eval());
  return box;
}

std::size_t world_bytes(const std::vector<sim::MeshPart>& parts) {
  std::size_t bytes = 0;
  for (const sim::MeshPart& part : parts) bytes += 6 * part.vertices_m.size() + 6 * part.triangles.size();
  return bytes;
}

std::size_t rate_lines(const std::vector<ReplayActor>& actors) {
  return static_cast<std::size_t>(
      std::count_if(actors.begin(), actors.end(), [](const ReplayActor& actor) { return !actor.rate_rad_s.empty(); }));
}

void add_rates(const ReplayInput& input, const ReplayLimits& limits, Replay& replay) {
  const std::size_t sample = kSampleBytes + kRateBytes * replay.actors.size();
  const std::size_t most = std::min(limits.strip_samples, limits.bytes / kStripShare / sample);
  replay.strip = strip_of(*input.sensors, input.truth, input.estimates, std::max<std::size_t>(most, 2));
  std::size_t actor = 0;
  if (input.truth != nullptr)
    replay.actors[actor++].rate_rad_s = true_rates(replay.strip, *input.sensors, *input.truth);
  for (const ReplayEstimate& given : input.estimates)
    replay.actors[actor++].rate_rad_s = estimated_rates(replay.strip, *input.sensors, *given.estimate);
}

void add_tracks(const std::vector<Motion>& motions, const ReplayLimits& limits, Replay& replay) {
  const auto tracks = static_cast<std::size_t>(
      std::count_if(motions.begin(), motions.end(), [](const Motion& motion) { return !motion.empty(); }));
  const std::size_t room = limits.bytes / kTracksShare / (kPoseBytes * tracks);
  const auto poses = static_cast<std::int64_t>(std::max<std::size_t>(std::min(limits.poses, room), 2));
  replay.pose_step_ns = std::max(kStep_ns, (replay.end_ns / (poses - 1) / 1000 + 1) * 1000);
  for (std::size_t i = 0; i < motions.size(); ++i)
    replay.actors[i].track = sampled(motions[i], replay.end_ns, replay.pose_step_ns);
}

void add_world(const ReplayInput& input, const ReplayLimits& limits, Replay& replay) {
  if (input.built != nullptr) {
    replay.world =
        thinned_world(sim::world_mesh(*input.built), surroundings(replay.actors), limits.triangles, replay.triangles);
    replay.robot = sim::robot_mesh(*input.built);
  }
  if (replay.robot.empty()) replay.robot = plain_body(input.sensors->sphere_radius_m);
  replay.robot_radius_m = radius_of(replay.robot);
}

void add_points(const ReplayInput& input, const std::vector<Motion>& motions, const ReplayLimits& limits,
                Replay& replay) {
  const std::size_t rates = replay.strip.time_ns.size() * (kSampleBytes + kRateBytes * rate_lines(replay.actors));
  std::size_t used = rates + world_bytes(replay.world) + world_bytes(replay.robot);
  std::size_t point = kPointBytes;
  for (const ReplayActor& actor : replay.actors) {
    used += kPoseBytes * actor.track.p_WB_m.size();
    if (!actor.track.p_WB_m.empty() && input.surface != nullptr) ++point;
  }
  const std::size_t left = limits.bytes > used ? limits.bytes - used : 0;
  replay.points = shown_points(*input.sensors, input.truth, std::min(limits.points, left / point));
  if (input.surface == nullptr || replay.points.p_B_m.empty()) return;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    ReplayActor& actor = replay.actors[i];
    if (!motions[i].empty()) actor.error_m = errors_of(replay.points, motions[i], actor.T_BB_given, *input.surface);
  }
}

}  // namespace

Replay replay_of(const ReplayInput& input, const ReplayLimits& limits) {
  require_parallel(*input.sensors);
  Replay replay;
  replay.title = input.title;
  replay.facts = input.facts;
  const std::vector<Motion> motions = motions_of(input, input.truth == nullptr ? 0 : input.truth->period_ns);
  replay.end_ns = std::max<std::int64_t>(last_instant(*input.sensors, input.truth, motions), 1);
  replay.actors = actors_of(input);
  add_rates(input, limits, replay);
  add_tracks(motions, limits, replay);
  find_motion(input, replay);
  add_world(input, limits, replay);
  add_points(input, motions, limits, replay);
  return replay;
}

}  // namespace tumble::tools
