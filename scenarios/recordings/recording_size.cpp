// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/recording_size.hpp"

#include "scenarios/recordings/recording_fields.hpp"
#include "scenarios/recordings/truth_fields.hpp"

namespace tumble::scenarios {

namespace {

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
    // HDF5 stores a chunk without compression if deflate does not shrink the chunk, and pads the last chunk.
    const std::uint64_t plain = std::uint64_t{rows.size()} * sizeof(Row);
    bytes += plain + plain / 1000 + hdf5::kChunkBytes + kHead_bytes;
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

}  // namespace

std::uint64_t size_bound(const RecordingInfo& info, const sim::Sensors& sensors, const std::vector<PointStore>& points,
                         const sim::Truth* truth) {
  SizeBound bound;
  for (const std::string* text : {&info.scenario, &info.situation_yaml, &info.tumble_version, &info.engine_version,
                                  &info.attribution, &info.digest})
    bound.value("", *text);
  const std::vector<StoredLidarView> lidars = views_of(sensors, points);
  sensors_fields(bound, sensors, lidars);
  if (truth == nullptr) return bound.bytes;
  const ContactColumns contacts = to_columns(truth->contacts);
  truth_fields(bound, *truth, contacts);
  return bound.bytes;
}

}  // namespace tumble::scenarios
