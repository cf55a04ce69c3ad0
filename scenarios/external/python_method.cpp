// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/external/python_method.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/external/answer_bounds.hpp"
#include "scenarios/external/external_method.hpp"
#include "scenarios/external/python_runner.hpp"
#include "scenarios/external/turning_sense.hpp"
#include "scenarios/recordings/scratch_file.hpp"

namespace tumble::scenarios {

namespace {

constexpr const char* kVersions = R"(
import sys
try:
    import numpy
except ImportError:
    sys.exit(sys.executable + " has no numpy, which a Python method needs: install numpy, or "
             "name another Python with the key `interpreter:` or with $TUMBLE_PYTHON")
print("Python", sys.version.split()[0] + ", numpy", numpy.__version__)
)";

Command interpreter(const ExternalDescription& description, const ScratchFolder& scratch,
                    const std::vector<std::string>& words) {
  Command command{.words = description.interpreter,
                  .folder = scratch.path(),
                  .environment = description.environment,
                  .transcript = scratch.path() / "transcript.txt",
                  .time_limit_s = description.time_limit_s,
                  .memory_limit_mib = description.memory_limit_mib};
  const char* own = std::getenv("TUMBLE_PYTHON");
  if (command.words.empty()) command.words = {own != nullptr && *own != '\0' ? own : "python3"};
  command.environment.emplace("PYTHONDONTWRITEBYTECODE", "1");  // no __pycache__ at the user's file
  command.words.insert(command.words.end(), words.begin(), words.end());
  return command;
}

}  // namespace

Estimate call_python(const ExternalDescription& description, const sim::Sensors& sensors, std::string& transcript) {
  SharedMemory given("tumble-sensors"), answer("tumble-answer");
  write_sensors(sensors, given);
  const ScratchFolder scratch("method");
  Command command =
      interpreter(description, scratch,
                  {"-c", kPythonRunner, description.python.string(), description.function, to_string(description.kind),
                   std::to_string(given.descriptor()), std::to_string(answer.descriptor())});
  command.descriptors = {given.descriptor(), answer.descriptor()};
  return without_folder(scratch.path(), [&] {
    const CommandEnd end = run_command(command);
    transcript = end.transcript;
    require_done(end);
    return read_answer(answer, description.kind, description.frame, sensors);
  });
}

std::string python_version(const ExternalDescription& description) {
  const ScratchFolder scratch("method");
  const std::string output =
      reported_version(interpreter(description, scratch, {"-c", kVersions}), description.file.string() + ": ");
  const std::string text = read_text_file(description.python);
  return fmt::format("{}; {} {:016x}", output, description.python.filename().string(),
                     XXH3_64bits(text.data(), text.size()));
}

namespace {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t kAlignment = 64;
constexpr double kQuaternionTolerance = 1e-2;

std::size_t aligned(std::size_t size) {
  return (size + kAlignment - 1) / kAlignment * kAlignment;
}

class Arrays {
 public:
  template <typename Value>
  json add(const char* dtype, const std::vector<Value>& rows, std::size_t columns = 0) {
    json shape = json::array({rows.size()});
    if (columns > 0) shape.push_back(columns);
    return place(dtype, shape, std::as_bytes(std::span(rows)));
  }
  json add(const Eigen::Isometry3d& T) {
    const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> rows = T.matrix();
    matrices_.emplace_back(rows.data(), rows.data() + rows.size());
    return place("<f8", {4, 4}, std::as_bytes(std::span(matrices_.back())));
  }
  void write(const json& text, SharedMemory& memory) const {
    const std::string head = text.dump(-1, ' ', false, json::error_handler_t::replace);
    const std::uint64_t length = head.size();
    std::string start(sizeof(length), '\0');
    std::memcpy(start.data(), &length, sizeof(length));
    start += head;
    start.resize(aligned(start.size()), '\0');
    memory.append(std::as_bytes(std::span(start)));
    const std::vector<std::byte> padding(kAlignment);
    for (const std::span<const std::byte> bytes : bytes_) {
      memory.append(bytes);
      memory.append(std::span(padding).first(aligned(bytes.size()) - bytes.size()));
    }
  }

 private:
  json place(const char* dtype, const json& shape, std::span<const std::byte> bytes) {
    json entry = {{"dtype", dtype}, {"shape", shape}, {"offset", offset_}};
    bytes_.push_back(bytes);
    offset_ += aligned(bytes.size());
    return entry;
  }

  std::vector<std::span<const std::byte>> bytes_;
  std::deque<std::vector<double>> matrices_;  // deque keeps the addresses valid
  std::size_t offset_ = 0;
};

static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double) && sizeof(Eigen::Vector3f) == 3 * sizeof(float));

json of_imu(const sim::ImuRecord& imu, Arrays& arrays) {
  const bool magnetometer = !imu.magnetic_field_t.empty();
  const Eigen::Vector3d& earth_t = imu.earth_field_W_t;
  return {{"name", imu.name},
          {"device", imu.device},
          {"period_ns", imu.period_ns},
          {"gyro_range_rad_s", imu.stated_gyro_range_rad_s},
          {"accel_range_m_s2", imu.stated_accel_range_m_s2},
          {"gyro_noise_rad_s_sqrt_hz", imu.gyro_noise_rad_s_sqrt_hz},
          {"accel_noise_m_s2_sqrt_hz", imu.accel_noise_m_s2_sqrt_hz},
          {"T_BI", arrays.add(imu.T_BI)},
          {"time_ns", arrays.add("<i8", imu.time_ns)},
          {"gyro", arrays.add("<f8", imu.gyro_rad_s, 3)},
          {"accel", arrays.add("<f8", imu.accel_m_s2, 3)},
          {"clip_flags", arrays.add("|u1", imu.clip_flags)},
          {"magnetic_field_t", magnetometer ? arrays.add("<f8", imu.magnetic_field_t, 3) : json()},
          {"earth_field_t", magnetometer ? json({earth_t.x(), earth_t.y(), earth_t.z()}) : json()}};
}

const char* to_string(sim::PointTimes times) {
  switch (times) {
    case sim::PointTimes::measured:
      return "measured";
    case sim::PointTimes::not_skewed:
      return "not_skewed";
    case sim::PointTimes::unknown:
      break;
  }
  return "unknown";
}

json of_lidar(const sim::LidarRecord& lidar, Arrays& arrays) {
  return {{"name", lidar.name},
          {"device", lidar.device},
          {"T_BL", arrays.add(lidar.T_BL)},
          {"sweep_period_ns", lidar.sweep_period_ns},
          {"point_times", to_string(lidar.point_times)},
          {"sweep_start_ns", arrays.add("<i8", lidar.sweep_start_ns)},
          {"sweep_first", arrays.add("<u8", lidar.sweep_first)},
          {"position", arrays.add("<f4", lidar.position_L_m, 3)},
          {"range_m", arrays.add("<f4", lidar.range_m)},
          {"intensity", arrays.add("<f4", lidar.intensity)},
          {"offset_ns", arrays.add("<u4", lidar.offset_ns)},
          {"ring", arrays.add("<u2", lidar.ring)}};
}

json of_series(const sim::SeriesRecord& series, Arrays& arrays) {
  json values = json::object(), units = json::object(), noise = json::object(), constants = json::object();
  for (const sim::Quantity& quantity : series.quantities) {
    values[quantity.name] = arrays.add("<f8", quantity.values);
    units[quantity.name] = quantity.unit;
    noise[quantity.name] = quantity.noise;
  }
  for (const sim::Constant& constant : series.constants) constants[constant.name] = constant.value;
  return {{"name", series.name},
          {"kind", series.kind},
          {"device", series.device},
          {"period_ns", series.period_ns},
          {"T_BX", arrays.add(series.T_BX)},
          {"time_ns", arrays.add("<i8", series.time_ns)},
          {"values", std::move(values)},
          {"units", std::move(units)},
          {"noise", std::move(noise)},
          {"constants", std::move(constants)}};
}

class Answer {
 public:
  Answer(const SharedMemory& memory, const AnswerBounds& bounds) {
    // The size of the shared memory is limited, because a faulty Python function can enlarge the shared memory.
    const std::uintmax_t most = bounds.table_bytes() + bounds.map_memory_bytes();
    if (memory.size() > most)
      throw BadInput(
          fmt::format("the result of the Python function has {} bytes; for this recording, it may have at most {}",
                      memory.size(), most));
    bytes_ = memory.contents();
    if (bytes_.empty()) throw BadInput("the Python interpreter ended before the function returned a result");
    std::uint64_t length = 0;
    if (bytes_.size() >= sizeof(length)) std::memcpy(&length, bytes_.data(), sizeof(length));
    if (length == 0 || length > bytes_.size() - sizeof(length)) fail();
    text_ = json::parse(bytes_.substr(sizeof(length), length), nullptr, false);
    if (!text_.is_object()) fail();
    first_ = aligned(sizeof(length) + length);
  }

  std::optional<std::string> text_of(const char* key) const {
    if (!text_.contains(key) || !text_[key].is_string()) return std::nullopt;
    return text_[key].get<std::string>();
  }
  bool has(const char* name) const { return text_.contains("arrays") && text_["arrays"].contains(name); }

  template <typename Value>
  std::vector<Value> array(const char* name, const char* dtype, std::size_t columns,
                           std::optional<std::size_t> rows) const {
    try {
      const json& entry = text_.at("arrays").at(name);
      const auto shape = entry.at("shape").get<std::vector<std::size_t>>();
      const auto offset = entry.at("offset").get<std::size_t>();
      if (shape.empty() || entry.at("dtype").get<std::string>() != dtype) fail();
      std::size_t count = sizeof(Value);
      for (const std::size_t size : shape) {
        if (size != 0 && count > bytes_.size() / size) fail();
        count *= size;
      }
      if (first_ > bytes_.size() || offset > bytes_.size() - first_ || count > bytes_.size() - first_ - offset) fail();
      if (count != sizeof(Value) * columns * shape[0] || (rows && shape[0] != *rows)) fail();
      std::vector<Value> out(count / sizeof(Value));
      if (count > 0) std::memcpy(out.data(), bytes_.data() + first_ + offset, count);
      return out;
    } catch (const json::exception&) {
      fail();
    }
  }

 private:
  [[noreturn]] static void fail() {
    throw BadInput("the result in shared memory is damaged; the Python function may have written into this memory");
  }

  std::string bytes_;
  json text_;
  std::size_t first_ = 0;
};

Eigen::Vector3d row_of(const std::vector<double>& rows, std::size_t k) {
  return {rows[3 * k], rows[3 * k + 1], rows[3 * k + 2]};
}

void read_rates(const Answer& answer, const sim::Sensors& sensors, Estimate& estimate) {
  if (sensors.imus.empty()) throw BadInput("the recording has no IMU; a rate method needs the samples of an IMU");
  const std::vector<std::int64_t>& stamps = sensors.imus.front().time_ns;
  const std::vector<double> rates = answer.array<double>("rate", "<f8", 3, stamps.size());
  std::vector<double> covariances;
  if (answer.has("covariance")) covariances = answer.array<double>("covariance", "<f8", 9, stamps.size());
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    AngularRateState rate;
    rate.time_ns = stamps[k];
    rate.w_WI_I_rad_s = row_of(rates, k);
    if (!covariances.empty())
      rate.covariance_rad2_s2 = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&covariances[9 * k]);
    estimate.rates.push_back(rate);
  }
}

std::vector<PoseState> read_poses(const Answer& answer) {
  const auto times_ns = answer.array<std::int64_t>("time_ns", "<i8", 1, {});
  const auto quaternions = answer.array<double>("quaternion", "<f8", 4, times_ns.size());
  std::vector<double> positions(3 * times_ns.size());
  if (answer.has("position")) positions = answer.array<double>("position", "<f8", 3, times_ns.size());
  std::vector<PoseState> poses(times_ns.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    poses[k].time_ns = times_ns[k];
    poses[k].position_W_m = row_of(positions, k);
    const Eigen::Quaterniond q{Eigen::Map<const Eigen::Vector4d>(&quaternions[4 * k])};
    if (!(std::abs(q.coeffs().stableNorm() - 1.0) <= kQuaternionTolerance) || (k > 0 && times_ns[k] <= times_ns[k - 1]))
      throw BadInput(fmt::format(
          "pose {} of the result has a quaternion whose norm is not 1, or a time that does not increase", k));
    poses[k].orientation_W = q.normalized();
  }
  return poses;
}

void read_map(const Answer& answer, Estimate& estimate) {
  const auto positions = answer.array<float>("map", "<f4", 3, {});
  for (std::size_t k = 0; k + 2 < positions.size(); k += 3)
    estimate.map.push_back({Eigen::Vector3f(positions[k], positions[k + 1], positions[k + 2])});
}

}  // namespace

void write_sensors(const sim::Sensors& sensors, SharedMemory& memory) {
  Arrays arrays;
  json imus = json::array(), lidars = json::array(), series = json::array();
  for (const sim::ImuRecord& imu : sensors.imus) imus.push_back(of_imu(imu, arrays));
  for (const sim::LidarRecord& lidar : sensors.lidars) lidars.push_back(of_lidar(lidar, arrays));
  for (const sim::SeriesRecord& each : sensors.series) series.push_back(of_series(each, arrays));
  const json text = {{"imus", std::move(imus)},
                     {"lidars", std::move(lidars)},
                     {"series", std::move(series)},
                     {"robot", sensors.robot},
                     {"sphere_radius_m", sensors.sphere_radius_m},
                     {"gravity_m_s2", sensors.gravity_m_s2}};
  arrays.write(text, memory);
  memory.seal();
}

Estimate read_answer(const SharedMemory& memory, Kind kind, Frame frame, const sim::Sensors& sensors) {
  const AnswerBounds bounds(sensors);
  const Answer answer(memory, bounds);
  if (const auto raised = answer.text_of("raised")) throw NoAnswer(NoAnswer::Why::crashed, *raised);
  if (const auto refused = answer.text_of("refused")) throw BadInput(*refused);
  Estimate estimate;
  estimate.frame = frame;
  if (kind == Kind::rate) {
    read_rates(answer, sensors, estimate);
    bounds.require_rates(estimate.rates, [](std::size_t k) { return "rate[" + std::to_string(k) + "]"; });
    return estimate;
  }
  estimate.poses = read_poses(answer);
  const AnswerBounds::Place place = [](std::size_t k) { return fmt::format("pose {} of the result", k); };
  bounds.require_unit(estimate, "nanoseconds", place);
  bounds.require_poses(estimate.poses, place);
  if (kind == Kind::attitude) {
    for (const PoseState& pose : std::exchange(estimate.poses, {}))
      estimate.attitudes.push_back({pose.time_ns, pose.orientation_W, Eigen::Matrix3d::Zero()});
  }
  if (kind == Kind::slam && answer.has("map")) read_map(answer, estimate);
  bounds.require_slam(estimate);
  if (const std::string complaint = turning_complaint(estimate, sensors); !complaint.empty())
    throw BadInput("the result is invalid: " + complaint);
  return estimate;
}

}  // namespace tumble::scenarios
