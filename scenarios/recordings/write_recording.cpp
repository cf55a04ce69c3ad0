// SPDX-License-Identifier: BSD-3-Clause
#include <stdexcept>

#include "scenarios/recordings/hdf5_file.hpp"
#include "scenarios/recordings/recording_check.hpp"
#include "scenarios/recordings/recording_fields.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/recordings/truth_fields.hpp"

namespace tumble::scenarios {

namespace {

class Writer {
 public:
  explicit Writer(hdf5::Group group) : group_(std::move(group)) {}

  template <class Value>
  void value(const char* name, const Value& value) {
    group_.write_attribute(name, value);
  }
  void pose(const char* name, const Eigen::Isometry3d& pose) {
    std::vector<Eigen::Vector4d> rows(4);
    for (int i = 0; i < 3; ++i) rows[static_cast<std::size_t>(i)] = pose.matrix().row(i).transpose();
    rows[3] = Eigen::Vector4d(0.0, 0.0, 0.0, 1.0);
    group_.write(name, rows, "1, last column m", "", false);
  }
  void point(const char* name, const Eigen::Vector3d& point, const char* unit) {
    group_.write(name, std::vector<Eigen::Vector3d>{point}, unit, kXyz, false);
  }
  template <class Row>
  void rows(const char* name, const std::vector<Row>& rows, const char* unit, const char* columns, Storage storage) {
    group_.write(name, rows, unit, columns, storage == Storage::deflated);
  }
  template <class Row>
  void rows(const char* name, const ColumnFile<Row>& rows, const char* unit, const char* columns, Storage storage) {
    group_.write(name, rows, unit, columns, storage == Storage::deflated);
  }
  template <class Row>
  void optional_rows(const char* name, const std::vector<Row>& given, const char* unit, const char* columns,
                     Storage storage) {
    if (!given.empty()) rows(name, given, unit, columns, storage);
  }
  void optional_point(const char* name, const Eigen::Vector3d& given, const char* unit) {
    if (!given.isZero(0.0)) point(name, given, unit);
  }
  void point_times(const char* name, sim::PointTimes given) {
    if (given != sim::PointTimes::measured) value(name, std::string(kPointTimes[static_cast<std::size_t>(given)]));
  }
  void texts(const char* name, const std::vector<std::string>& texts) { group_.write_texts(name, texts); }
  template <class Record, class Fields>
  void group(const char* name, const Record& record, Fields&& fields) {
    Writer inner(group_.create(name));
    fields(inner, record);
  }
  template <class Record, class Fields>
  void list(const char* name, const std::vector<Record>& records, Fields&& fields) {
    const hdf5::Group all = group_.create(name);
    for (std::size_t i = 0; i < records.size(); ++i) {
      Writer inner(all.create(std::to_string(i)));
      fields(inner, records[i]);
    }
  }
  template <class Record, class Fields>
  void optional_list(const char* name, const std::vector<Record>& records, Fields&& fields) {
    if (!records.empty()) list(name, records, fields);
  }

 private:
  hdf5::Group group_;
};

void require_consistent(const sim::Sensors& sensors, const std::vector<PointStore>& points, const sim::Truth* truth) {
  std::string problem = find_problem(sensors, points);
  if (truth != nullptr && problem.empty()) problem = find_problem(*truth);
  if (truth != nullptr && problem.empty()) problem = find_mismatch(sensors, *truth);
  if (!problem.empty()) throw std::invalid_argument("recording: " + problem);
}

void write_info(const hdf5::Group& root, const RecordingInfo& info, const std::string& digest_of_all, bool has_truth) {
  root.write_attribute("format", kRecordingFormat);
  root.write_attribute("format_version", std::int64_t{kRecordingVersion});
  root.write_attribute("scenario", info.scenario);
  root.write_attribute("seed", info.seed);
  root.write_attribute("situation_yaml", info.situation_yaml);
  root.write_attribute("tumble_version", info.tumble_version);
  root.write_attribute("engine_version", info.engine_version);
  root.write_attribute("attribution", info.attribution);
  if (info.origin_ns != 0) root.write_attribute("origin_ns", info.origin_ns);
  root.write_attribute("digest", digest_of_all);
  root.write_attribute("has_truth", std::int64_t{has_truth});
}

void write_truth(const hdf5::Group& root, const sim::Truth* truth) {
  if (truth == nullptr) return;
  Writer writer(root.create("truth"));
  writer.value("digest", digest(*truth));
  const ContactColumns contacts = to_columns(truth->contacts);
  truth_fields(writer, *truth, contacts);
}

constexpr std::uint64_t kHead_bytes = 4096, kFile_bytes = std::uint64_t{1} << 20;

class SizeBound {
 public:
  std::uint64_t bytes = kFile_bytes;

  void value(const char*, const std::string& text) { bytes += kHead_bytes + text.size(); }
  void value(const char*, double) { bytes += kHead_bytes; }
  void value(const char*, std::int64_t) { bytes += kHead_bytes; }
  void pose(const char*, const Eigen::Isometry3d&) { bytes += kHead_bytes; }
  void point(const char*, const Eigen::Vector3d&, const char*) { bytes += kHead_bytes; }
  template <template <class...> class Rows, class Row, class... More>
  void rows(const char*, const Rows<Row, More...>& rows, const char*, const char*, Storage) {
    // If deflate does not shrink a chunk, HDF5 stores the chunk without compression. HDF5 pads the last chunk to the
    // full chunk size.
    const std::uint64_t plain = std::uint64_t{rows.size()} * sizeof(Row);
    const std::uint64_t padding = plain > hdf5::kChunkBytes ? hdf5::kChunkBytes : 0;
    bytes += plain + plain / 1000 + padding + kHead_bytes;
  }
  template <class Row>
  void optional_rows(const char* name, const std::vector<Row>& given, const char* unit, const char* columns,
                     Storage storage) {
    rows(name, given, unit, columns, storage);
  }
  void optional_point(const char*, const Eigen::Vector3d&, const char*) { bytes += kHead_bytes; }
  void point_times(const char*, sim::PointTimes) { bytes += kHead_bytes; }
  void texts(const char*, const std::vector<std::string>& texts) {
    std::size_t longest = 1;
    for (const std::string& text : texts) longest = std::max(longest, text.size());
    bytes += kHead_bytes + longest * texts.size();
  }
  template <class Record, class Fields>
  void group(const char*, const Record& record, Fields&& fields) {
    bytes += kHead_bytes;
    fields(*this, record);
  }
  template <class Record, class Fields>
  void list(const char*, const std::vector<Record>& records, Fields&& fields) {
    bytes += kHead_bytes;
    for (const Record& record : records) group("", record, fields);
  }
  template <class Record, class Fields>
  void optional_list(const char* name, const std::vector<Record>& records, Fields&& fields) {
    list(name, records, fields);
  }
};

std::uint64_t size_bound(const RecordingInfo& info, const sim::Sensors& sensors, const std::vector<PointStore>& points,
                         const sim::Truth* truth) {
  SizeBound bound;
  for (const std::string* text : {&info.scenario, &info.situation_yaml, &info.tumble_version, &info.engine_version,
                                  &info.attribution, &info.digest})
    bound.value("", *text);
  stored_fields(bound, sensors, points);
  if (truth == nullptr) return bound.bytes;
  const ContactColumns contacts = to_columns(truth->contacts);
  truth_fields(bound, *truth, contacts);
  return bound.bytes;
}

}  // namespace

void write_recording(const std::filesystem::path& path, const RecordingInfo& info, const sim::Sensors& sensors,
                     const sim::Truth* truth) {
  write_recording(path, info, sensors, {}, truth);
}

void write_recording(const std::filesystem::path& path, const RecordingInfo& info, const sim::Sensors& sensors,
                     const std::vector<PointStore>& points, const sim::Truth* truth) {
  require_consistent(sensors, points, truth);
  OutputFile output(path);
  hdf5::DiskFile file(path.string(), output.unfinished(), size_bound(info, sensors, points, truth));
  write_info(file.root(), info, digest(sensors, points, truth), truth != nullptr);
  {
    Writer writer(file.root().create("sensors"));
    writer.value("digest", digest(sensors, points, nullptr));
    stored_fields(writer, sensors, points);
  }
  write_truth(file.root(), truth);
  file.close();
  output.move_into_place();
}

}  // namespace tumble::scenarios
