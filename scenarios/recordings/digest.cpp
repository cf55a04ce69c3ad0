// SPDX-License-Identifier: BSD-3-Clause
#include <span>

#include "scenarios/provenance/hasher.hpp"
#include "scenarios/recordings/recording_fields.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/recordings/truth_fields.hpp"

namespace tumble::scenarios {

namespace {

class FieldHasher : public Hasher {
 public:
  void value(const char* name, const std::string& value) {
    text(name);
    text(value);
  }
  template <class Number>
  void value(const char* name, const Number& value) {
    text(name);
    bytes(&value, sizeof(value));
  }
  void pose(const char* name, const Eigen::Isometry3d& pose) {
    text(name);
    const Eigen::Matrix<double, 3, 4> upper = pose.matrix().topRows<3>();
    bytes(upper.data(), sizeof(double) * 12);
  }
  void point(const char* name, const Eigen::Vector3d& point, const char*) {
    text(name);
    bytes(point.data(), sizeof(double) * 3);
  }
  template <class Row>
  void rows(const char* name, const std::vector<Row>& rows, const char*, const char*, Storage) {
    text(name);
    count(rows.size());
    bytes(rows.data(), rows.size() * sizeof(Row));
  }
  template <class Row>
  void rows(const char* name, const ColumnFile<Row>& rows, const char*, const char*, Storage) {
    constexpr std::size_t kLength = (std::size_t{1} << 20) / sizeof(Row);
    text(name);
    count(rows.size());
    rows.for_segments(kLength,
                      [&](std::size_t, std::span<const Row> segment) { bytes(segment.data(), segment.size_bytes()); });
  }
  template <class Row>
  void optional_rows(const char* name, const std::vector<Row>& given, const char* unit, const char* columns,
                     Storage storage) {
    if (!given.empty()) rows(name, given, unit, columns, storage);
  }
  template <class Row>
  void optional_rows(const char* name, const ColumnFile<Row>& given, const char* unit, const char* columns,
                     Storage storage) {
    if (given.size() > 0) rows(name, given, unit, columns, storage);
  }
  void optional_point(const char* name, const Eigen::Vector3d& given, const char* unit) {
    if (!given.isZero(0.0)) point(name, given, unit);
  }
  void point_times(const char* name, sim::PointTimes given) {
    if (given != sim::PointTimes::measured) value(name, std::string(kPointTimes[static_cast<std::size_t>(given)]));
  }
  void texts(const char* name, const std::vector<std::string>& texts) {
    text(name);
    count(texts.size());
    for (const std::string& each : texts) text(each);
  }
  template <class Record, class Fields>
  void group(const char* name, const Record& record, Fields&& fields) {
    text(name);
    fields(*this, record);
  }
  template <class Record, class Fields>
  void list(const char* name, const std::vector<Record>& records, Fields&& fields) {
    text(name);
    count(records.size());
    for (const Record& record : records) fields(*this, record);
  }
  template <class Record, class Fields>
  void optional_list(const char* name, const std::vector<Record>& records, Fields&& fields) {
    if (!records.empty()) list(name, records, fields);
  }
};

void hash_truth(FieldHasher& hasher, const sim::Truth& truth) {
  const ContactColumns contacts = to_columns(truth.contacts);
  hasher.text("truth");
  truth_fields(hasher, truth, contacts);
}

}  // namespace

std::string digest(const StoredTruth& truth) {
  FieldHasher hasher;
  hasher.text("truth");
  truth_fields(hasher, truth, truth.contacts);
  return hasher.hex();
}

std::string digest(const sim::Sensors& sensors, const std::vector<PointStore>& points, const sim::Truth* truth) {
  FieldHasher hasher;
  hasher.text("sensors");
  stored_fields(hasher, sensors, points);
  if (truth != nullptr) hash_truth(hasher, *truth);
  return hasher.hex();
}

std::string digest(const sim::Sensors& sensors, const sim::Truth* truth) {
  return digest(sensors, {}, truth);
}

std::string digest(const sim::Truth& truth) {
  FieldHasher hasher;
  hash_truth(hasher, truth);
  return hasher.hex();
}

}  // namespace tumble::scenarios
