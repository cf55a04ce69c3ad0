// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/data_root.hpp"

namespace tumble::scenarios {

struct CertificateEntry {
  std::string row;      ///< measured quantity: "free_flight_energy"
  std::string subject;  ///< measured object: "rig", "hill", "mti30 gyro"
  std::string law;
  std::string unit;  ///< "1" if dimensionless
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;                                             ///< both bounds are inclusive
  std::string note;                                              ///< reason why `value` is missing; otherwise empty
  bool passes() const { return value >= low && value <= high; }  ///< false for NaN
  bool operator==(const CertificateEntry&) const = default;
};

struct Certificate {
  std::string build;  ///< build_id()
  std::vector<CertificateEntry> entries;
  bool passes() const;  ///< at least one entry exists, and all entries pass
  bool operator==(const Certificate&) const = default;
};

struct CertificateInput {
  DataRoot data;
  std::filesystem::path program;  ///< computes a digest in a new process
};

struct CertificateRow {
  std::string name;
  std::string doc;
  std::vector<CertificateEntry> (*measure)(const CertificateInput& input);
};

std::span<const CertificateRow> certificate_rows();

struct CertifyOptions {
  std::vector<std::string> rows;                                        ///< names of the measurements; empty: all
  const std::atomic<bool>* stop = nullptr;                              ///< stops after the current measurement
  std::function<void(const CertificateRow&, double elapsed_s)> on_row;  ///< called before each measurement
};

/// Measures how well the simulation agrees with physical laws and data sheets. If a check cannot be measured, its entry
/// contains the reason and the value NaN, and does not pass.
Certificate measure_certificate(const CertificateInput& input, const CertifyOptions& options);

}  // namespace tumble::scenarios
