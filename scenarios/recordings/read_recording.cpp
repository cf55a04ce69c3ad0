// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/recording_check.hpp"
#include "scenarios/recordings/recording_fields.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/recordings/truth_fields.hpp"

namespace tumble::scenarios {

namespace {

class RecordingReader {
 public:
  explicit RecordingReader(hdf5::Group group, std::filesystem::path scratch = {})
      : group_(std::move(group)), scratch_(std::move(scratch)) {}

  void value(const char* name, std::string& value) { value = group_.text_attribute(name); }
  void value(const char* name, double& value) { value = group_.double_attribute(name); }
  void value(const char* name, std::int64_t& value) { value = group_.int_attribute(name); }
  void pose(const char* name, Eigen::Isometry3d& pose) {
    std::vector<Eigen::Vector4d> rows;
    group_.read(name, rows);
    if (rows.size() != 4 || rows[3] != Eigen::Vector4d(0.0, 0.0, 0.0, 1.0)) {
      group_.fail(name, "the dataset must be a 4 x 4 matrix with the last row 0 0 0 1");
    }
    for (int i = 0; i < 3; ++i) pose.matrix().row(i) = rows[static_cast<std::size_t>(i)].transpose();
  }
  void point(const char* name, Eigen::Vector3d& point, const char*) {
    std::vector<Eigen::Vector3d> rows;
    group_.read(name, rows);
    if (rows.size() != 1) group_.fail(name, "the dataset must have exactly one row");
    point = rows[0];
  }
  template <class Row>
  void rows(const char* name, std::vector<Row>& rows, const char*, const char*, Storage) {
    group_.read(name, rows);
  }
  template <class Row>
  void rows(const char* name, ColumnFile<Row>& rows, const char*, const char*, Storage) {
    rows = ColumnFile<Row>(scratch_);
    group_.read(name, rows);
  }
  template <class Row>
  void optional_rows(const char* name, std::vector<Row>& rows, const char*, const char*, Storage) {
    if (group_.has(name)) group_.read(name, rows);
  }
  template <class Row>
  void optional_rows(const char* name, ColumnFile<Row>& given, const char* unit, const char* columns, Storage storage) {
    if (group_.has(name)) rows(name, given, unit, columns, storage);
  }
  void optional_point(const char* name, Eigen::Vector3d& given, const char* unit) {
    if (group_.has(name)) point(name, given, unit);
  }
  void point_times(const char* name, sim::PointTimes& given) {
    if (!group_.has_attribute(name)) return;
    const std::string word = group_.text_attribute(name);
    const auto* found = std::find(kPointTimes.begin(), kPointTimes.end(), word);
    if (found == kPointTimes.end())
      group_.fail(
          name,
          fmt::format("the attribute for the kind of point times is '{}'; it must be measured, not_skewed or unknown",
                      word));
    given = static_cast<sim::PointTimes>(found - kPointTimes.begin());
  }
  void texts(const char* name, std::vector<std::string>& texts) { texts = group_.read_texts(name); }
  template <class Record, class Fields>
  void group(const char* name, Record& record, Fields&& fields) {
    RecordingReader inner(group_.open(name), scratch_);
    fields(inner, record);
  }
  template <class Record, class Fields>
  void list(const char* name, std::vector<Record>& records, Fields&& fields) {
    const hdf5::Group all = group_.open(name);
    const std::size_t count = all.count();
    for (std::size_t i = 0; i < count; ++i) {
      RecordingReader inner(all.open(std::to_string(i)), scratch_);
      fields(inner, records.emplace_back());
    }
  }
  template <class Record, class Fields>
  void optional_list(const char* name, std::vector<Record>& records, Fields&& fields) {
    if (group_.has(name)) list(name, records, fields);
  }

  std::string digest_or_empty() const { return group_.has_attribute("digest") ? group_.text_attribute("digest") : ""; }

 private:
  hdf5::Group group_;
  std::filesystem::path scratch_;
};

template <class Columns>
void require_one_length(const Columns& columns, const std::string& file) {
  for (const std::size_t other : {columns.point_W_m.size(), columns.normal_W.size(), columns.slip_velocity_W_m_s.size(),
                                  columns.normal_force_n.size(), columns.surface_id.size()}) {
    if (other != columns.time_ns.size())
      throw BadInput(fmt::format("{}: truth/contacts: all datasets of the contacts must have the same length", file));
  }
}

std::vector<sim::ContactTruth> from_columns(const ContactColumns& columns, const std::string& file) {
  require_one_length(columns, file);
  const std::size_t count = columns.time_ns.size();
  std::vector<sim::ContactTruth> contacts(count);
  for (std::size_t i = 0; i < count; ++i) {
    contacts[i] = {columns.time_ns[i],        columns.point_W_m[i], columns.normal_W[i], columns.slip_velocity_W_m_s[i],
                   columns.normal_force_n[i], columns.surface_id[i]};
  }
  return contacts;
}

void require_format(const hdf5::Group& root) {
  if (!root.has_attribute("format") || root.text_attribute("format") != kRecordingFormat) {
    root.fail("format",
              fmt::format("the file is not a recording of tumble: the attribute 'format' must be '{}'. For an HDF5 "
                          "file of the BROAD data set, call tumble.read_broad and tumble.write of the Python package",
                          kRecordingFormat));
  }
  const std::int64_t version = root.int_attribute("format_version");
  if (version != kRecordingVersion) {
    root.fail("format_version",
              fmt::format("the version of the recording format is {}; this build of tumble reads only version {}",
                          version, kRecordingVersion));
  }
}

hdf5::Group truth_group(const hdf5::InputFile& file, const std::filesystem::path& path) {
  require_format(file.root());
  if (!file.root().has("truth"))
    throw BadInput(fmt::format(
        "{}: the recording has no truth; only simulated recordings and recordings with a reference have truth",
        path.string()));
  return file.root().open("truth");
}

void require_sound(const std::string& file, const std::string& problem, const std::string& stored,
                   const std::string& found) {
  if (!problem.empty()) throw BadInput(file + ": " + problem);
  if (!stored.empty() && stored != found) {
    throw BadInput(
        fmt::format("{}: the file is damaged or was changed: the digest of its data is {}, but the stored digest is {}",
                    file, found, stored));
  }
}

}  // namespace

ContactColumns to_columns(const std::vector<sim::ContactTruth>& contacts) {
  ContactColumns out;
  for (const sim::ContactTruth& contact : contacts) {
    out.time_ns.push_back(contact.time_ns);
    out.point_W_m.push_back(contact.point_W_m);
    out.normal_W.push_back(contact.normal_W);
    out.slip_velocity_W_m_s.push_back(contact.slip_velocity_W_m_s);
    out.normal_force_n.push_back(contact.normal_force_n);
    out.surface_id.push_back(contact.surface_id);
  }
  return out;
}

RecordingInfo read_info(const std::filesystem::path& path) {
  const hdf5::InputFile file(path);
  const hdf5::Group& root = file.root();
  require_format(root);
  RecordingInfo info;
  info.format_version = kRecordingVersion;
  info.scenario = root.text_attribute("scenario");
  info.seed = root.uint_attribute("seed");
  info.situation_yaml = root.text_attribute("situation_yaml");
  info.tumble_version = root.text_attribute("tumble_version");
  info.engine_version = root.text_attribute("engine_version");
  info.attribution = root.text_attribute("attribution");
  if (root.has_attribute("origin_ns")) info.origin_ns = root.int_attribute("origin_ns");
  info.digest = root.text_attribute("digest");
  info.has_truth = root.int_attribute("has_truth") != 0;
  return info;
}

sim::Sensors read_sensors(const std::filesystem::path& path) {
  const hdf5::InputFile file(path);
  require_format(file.root());
  RecordingReader reader(file.root().open("sensors"));
  sim::Sensors sensors;
  sensors_fields(reader, sensors);
  require_sound(path.string(), find_problem(sensors), reader.digest_or_empty(), digest(sensors, nullptr));
  return sensors;
}

sim::Sensors read_sensors(const std::filesystem::path& path, const std::filesystem::path& scratch,
                          std::vector<PointStore>& points) {
  const hdf5::InputFile file(path);
  require_format(file.root());
  RecordingReader reader(file.root().open("sensors"), scratch);
  sim::Sensors sensors;
  std::vector<StoredLidar> lidars;
  sensors_fields(reader, sensors, lidars);
  points.clear();
  for (StoredLidar& each : lidars) {
    sensors.lidars.push_back(std::move(each.sweeps));
    points.push_back(std::move(each.points));
  }
  require_sound(path.string(), find_problem(sensors, points), reader.digest_or_empty(),
                digest(sensors, points, nullptr));
  return sensors;
}

bool states_digest(const std::filesystem::path& path) {
  const hdf5::InputFile file(path);
  require_format(file.root());
  return file.root().open("sensors").has_attribute("digest");
}

sim::Truth read_truth(const std::filesystem::path& path) {
  const hdf5::InputFile file(path);
  RecordingReader reader(truth_group(file, path));
  sim::Truth truth;
  ContactColumns contacts;
  truth_fields(reader, truth, contacts);
  truth.contacts = from_columns(contacts, path.string());
  require_sound(path.string(), find_problem(truth), reader.digest_or_empty(), digest(truth));
  return truth;
}

StoredTruth read_truth(const std::filesystem::path& path, const std::filesystem::path& scratch) {
  const hdf5::InputFile file(path);
  RecordingReader reader(truth_group(file, path), scratch);
  StoredTruth truth;
  truth_fields(reader, truth, truth.contacts);
  require_one_length(truth.contacts, path.string());
  require_sound(path.string(), find_problem(truth), reader.digest_or_empty(), digest(truth));
  return truth;
}

}  // namespace tumble::scenarios
