// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/bag_messages.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/bags/sweep_messages.hpp"
#include "scenarios/recordings/export_names.hpp"
#include "scenarios/recordings/recording_file.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::int64_t kTruthStep_ns = 5000000, kClockStep_ns = 10000000;
constexpr const char *kWorld = "world", *kBody = "body";

/// `time_ns` is the time at which a subscriber would receive the message, which is the end of a sweep.
struct Event {
  enum Kind { imu, sweep, truth, pose, cloud };
  std::int64_t time_ns;
  Kind kind;
  std::size_t of, index;  ///< sensor or track, and reading
};

void add_truth(const StoredTruth& truth, std::vector<Event>& events) {
  constexpr std::size_t kSegment = 16384;
  const auto step = static_cast<std::size_t>(std::max<std::int64_t>(kTruthStep_ns / truth.period_ns, 1));
  truth.p_WB_m.for_segments(kSegment, [&](std::size_t first, std::span<const Eigen::Vector3d> p_WB_m) {
    const std::vector<Eigen::Quaterniond> q_WB = truth.q_WB.rows(first, first + p_WB_m.size());
    for (std::size_t i = (first + step - 1) / step * step; i < first + p_WB_m.size(); i += step) {
      if (!p_WB_m[i - first].allFinite() || !q_WB[i - first].coeffs().allFinite()) continue;
      events.push_back({static_cast<std::int64_t>(i) * truth.period_ns, Event::truth, 0, i});
    }
  });
}

BagTrack::Pose pose_of(const StoredTruth& truth, std::size_t i) {
  const sim::Truth state = truth.states(i, i + 1);
  BagTrack::Pose pose{static_cast<std::int64_t>(i) * truth.period_ns, state.p_WB_m[0], state.q_WB[0]};
  pose.v_WB_B_m_s = state.q_WB[0].conjugate() * state.v_WB_m_s[0];
  pose.w_WB_B_rad_s = state.w_WB_B_rad_s[0];
  pose.exact = true;
  return pose;
}

std::vector<Event> events_of(const sim::Sensors& sensors, std::size_t imus, std::size_t lidars,
                             const BagWriting& writing) {
  std::vector<Event> events;
  for (std::size_t s = 0; s < imus; ++s) {
    const std::vector<std::int64_t>& times = sensors.imus[s].time_ns;
    for (std::size_t i = 0; i < times.size(); ++i) events.push_back({times[i], Event::imu, s, i});
  }
  for (std::size_t s = 0; s < lidars; ++s) {
    const sim::LidarRecord& lidar = sensors.lidars[s];
    for (std::size_t i = 0; i < lidar.sweep_start_ns.size(); ++i) {
      if (!writing.empty_sweeps && lidar.sweep_first[i] == lidar.sweep_first[i + 1]) continue;
      events.push_back({lidar.sweep_start_ns[i] + lidar.sweep_period_ns, Event::sweep, s, i});
    }
  }
  if (writing.truth != nullptr) add_truth(*writing.truth, events);
  const std::vector<BagTrack>& tracks = writing.tracks;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    for (std::size_t i = 0; i < tracks[t].poses.size(); ++i)
      events.push_back({tracks[t].poses[i].time_ns, Event::pose, t, i});
  }
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    for (std::size_t i = 0; i < tracks[t].cloud_time_ns.size(); ++i)
      events.push_back({tracks[t].cloud_time_ns[i], Event::cloud, t, i});
  }
  const auto earlier = [](const Event& a, const Event& b) { return a.time_ns < b.time_ns; };
  std::stable_sort(events.begin(), events.end(), earlier);
  return events;
}

std::vector<Event> first_readings(std::size_t imus, const std::vector<Event>& events) {
  std::vector<Event> first;
  for (std::size_t s = 0; s < imus; ++s) {
    const auto of_it = [&](const Event& event) { return event.kind == Event::imu && event.of == s; };
    const auto found = std::find_if(events.begin(), events.end(), of_it);
    if (found != events.end()) first.push_back(*found);
  }
  return first;
}

struct SensorNames {
  std::string topic, frame;
};

std::vector<SensorNames> names_of_imus(const sim::Sensors& sensors, const std::optional<ReaderNames>& names) {
  std::vector<SensorNames> out;
  for (const std::string& name : export_names(sensors).imus.names) out.push_back({"/" + name, name});
  if (names && !out.empty()) out = {{names->imu_topic, names->imu_frame}};
  return out;
}

std::vector<SensorNames> names_of_lidars(const sim::Sensors& sensors, const std::optional<ReaderNames>& names) {
  std::vector<SensorNames> out;
  for (const std::string& name : export_names(sensors).lidars.names) out.push_back({"/" + name + "/points", name});
  if (names && !out.empty()) out = {{names->points_topic, names->lidar_frame}};
  return out;
}

class Export {
 public:
  Export(const sim::Sensors& sensors, const BagWriting& writing, BagWriter& bag)
      : sensors_(sensors),
        writing_(writing),
        bag_(bag),
        origin_ns_(export_origin_ns(writing.origin_ns)),
        imus_(names_of_imus(sensors, writing.names)),
        lidars_(names_of_lidars(sensors, writing.names)),
        body_(writing.names ? writing.names->body_frame : kBody) {}

  void all() {
    std::vector<Event> events = events_of(sensors_, imus_.size(), lidars_.size(), writing_);
    if (!events.empty()) write_mountings(stamp_of(events.front().time_ns));
    begin_with_imus(events);
    for (const Event& event : events) {
      if (event.kind == Event::cloud) {
        write_cloud(event);
        continue;
      }
      write_clock(event.time_ns);
      write(event, stamp_of(event.time_ns));
    }
    bag_.finish();
  }

 private:
  std::int64_t stamp_of(std::int64_t time_ns) const {
    if (origin_ns_ + time_ns < 0)
      throw BadInput("the time stamp of a reading is before 1970; a bag can only store later time stamps");
    return origin_ns_ + time_ns;
  }

  /// Readers use the first IMU in a bag as primary IMU. If necessary, the first messages of all IMUs are therefore
  /// written at the start of the bag, in the order of the IMUs.
  void begin_with_imus(std::vector<Event>& events) {
    const std::vector<Event> first = first_readings(imus_.size(), events);
    const auto earlier = [](const Event& a, const Event& b) { return a.time_ns < b.time_ns; };
    if (std::is_sorted(first.begin(), first.end(), earlier)) return;
    std::vector<BagTopic> topics;
    for (const Event& event : first) topics.push_back({imus_[event.of].topic, ros::type_of(ros::Imu{})});
    if (bag_.begin_with(topics)) return;
    std::erase_if(events, [](const Event& event) { return event.kind == Event::imu && event.index == 0; });
    for (const Event& event : first) write(event, stamp_of(event.time_ns));
  }

  void write_mountings(std::int64_t stamp) {
    ros::TFMessage message;
    const auto add = [&](const Eigen::Isometry3d& T_BA, const std::string& frame) {
      const Eigen::Quaterniond q_BA = Eigen::Quaterniond(T_BA.linear()).normalized();
      message.transforms.push_back(transform_message(T_BA.translation(), q_BA, frame, header_of(stamp, body_)));
    };
    for (std::size_t s = 0; s < imus_.size(); ++s) add(sensors_.imus[s].T_BI, imus_[s].frame);
    for (std::size_t s = 0; s < lidars_.size(); ++s) add(sensors_.lidars[s].T_BL, lidars_[s].frame);
    if (writing_.names && !writing_.names->fixed_frame.empty()) {
      message.transforms.push_back(transform_message(Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity(), body_,
                                                     header_of(stamp, writing_.names->fixed_frame)));
    }
    if (!message.transforms.empty()) bag_.write("/tf_static", stamp, message);
  }

  void write_clock(std::int64_t time_ns) {
    if (tick_ns_ && time_ns < *tick_ns_ + kClockStep_ns) return;
    tick_ns_ = time_ns;
    bag_.write("/clock", stamp_of(time_ns), clock_message(stamp_of(time_ns)));
  }

  void write(const Event& event, std::int64_t stamp) {
    switch (event.kind) {
      case Event::imu: {
        const SensorNames& sensor = imus_[event.of];
        return bag_.write(sensor.topic, stamp,
                          imu_message(sensors_.imus[event.of], event.index, header_of(stamp, sensor.frame)));
      }
      case Event::sweep: {
        const sim::LidarRecord& lidar = sensors_.lidars[event.of];
        const SensorNames& sensor = lidars_[event.of];
        const std::int64_t start_ns = stamp_of(lidar.sweep_start_ns[event.index]);
        const ros::Header header = header_of(start_ns, sensor.frame);
        if (writing_.points == nullptr)
          return bag_.write(sensor.topic, stamp, sweep_message(lidar, event.index, writing_.sweeps, start_ns, header));
        const sim::LidarRecord alone = sweep_alone(lidar, &writing_.points->at(event.of), event.index);
        return bag_.write(sensor.topic, stamp, sweep_message(alone, 0, writing_.sweeps, start_ns, header));
      }
      case Event::truth:
        return write_pose(pose_of(*writing_.truth, event.index), "truth", body_, stamp);
      case Event::pose: {
        const BagTrack& track = writing_.tracks[event.of];
        const bool body = event.of == 0 && writing_.truth == nullptr;
        return write_pose(track.poses[event.index], track.name, body ? body_ : track.name, stamp);
      }
      case Event::cloud:
        break;
    }
  }

  void write_pose(const BagTrack::Pose& pose, const std::string& name, const std::string& child, std::int64_t stamp) {
    const ros::Header header = header_of(stamp, kWorld);
    bag_.write("/" + name, stamp, odometry_message(pose, child, header));
    bag_.write("/tf", stamp, ros::TFMessage{{transform_message(pose.p_WB_m, pose.q_WB, child, header)}});
  }

  void write_cloud(const Event& event) {
    const BagTrack& track = writing_.tracks[event.of];
    const BagCloud cloud = track.cloud(track, event.index);
    if (cloud.position_W_m.empty()) return;
    write_clock(event.time_ns);
    const std::int64_t stamp = stamp_of(event.time_ns);
    bag_.write("/" + track.name + "/points", stamp, cloud_message(cloud, header_of(stamp, kWorld)));
  }

  const sim::Sensors& sensors_;
  const BagWriting& writing_;
  BagWriter& bag_;
  std::int64_t origin_ns_;
  std::vector<SensorNames> imus_, lidars_;
  std::string body_;
  std::optional<std::int64_t> tick_ns_;  ///< latest clock message
};

void write_bag(const sim::Sensors& sensors, const BagWriting& writing, BagWriter& bag) {
  Export(sensors, writing, bag).all();
}

}  // namespace

void export_ros1_bag(const sim::Sensors& sensors, const BagWriting& writing, const std::filesystem::path& file) {
  write_bag(sensors, writing, *make_ros1_writer(file));
}

void export_ros2_bag(const sim::Sensors& sensors, const BagWriting& writing, const std::filesystem::path& folder) {
  write_bag(sensors, writing, *make_ros2_writer(folder));
}

void export_mcap(const sim::Sensors& sensors, const BagWriting& writing, const std::filesystem::path& file) {
  write_bag(sensors, writing, *make_mcap_writer(file));
}

void export_ros2_mcap(const sim::Sensors& sensors, const BagWriting& writing, const std::filesystem::path& folder) {
  write_bag(sensors, writing, *make_ros2_mcap_writer(folder));
}

}  // namespace tumble::scenarios
