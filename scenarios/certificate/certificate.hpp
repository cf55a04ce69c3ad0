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

/// One measured number of the certificate, with its bounds.
struct CertificateEntry {
  std::string row;      ///< quantity: "free_flight_energy"
  std::string subject;  ///< object: "rig", "hill", "mti30 gyro"
  std::string law;      ///< physical law or specification, one sentence
  std::string unit;     ///< "1" if dimensionless
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;                                             ///< both bounds are inclusive
  std::string note;                                              ///< why there is no value; else empty
  bool passes() const { return value >= low && value <= high; }  ///< false for NaN
  bool operator==(const CertificateEntry&) const = default;
};

/// Measured deviation of this build from physics and from its data sheets.
struct Certificate {
  std::string build;  ///< build_id()
  std::vector<CertificateEntry> entries;
  bool passes() const;  ///< True if there is at least one entry and all pass.
  bool operator==(const Certificate&) const = default;
};

/// Inputs of the measurements.
struct CertificateInput {
  DataRoot data;
  std::filesystem::path program;  ///< the program `tumble`, started to check the digest in a new process
};

/// A row of the certificate, one file and one line of registration each. `measure` uses the certificate's default
/// setup; rows.hpp has versions with a custom setup.
struct CertificateRow {
  std::string name;
  std::string doc;
  std::vector<CertificateEntry> (*measure)(const CertificateInput& input);
};

/// Returns all rows, in order.
std::span<const CertificateRow> certificate_rows();

struct CertifyOptions {
  std::vector<std::string> rows;            ///< names; empty: all
  const std::atomic<bool>* stop = nullptr;  ///< set to stop after the current row; returns the entries so far
  std::function<void(const CertificateRow&, double elapsed_s)> on_row;  ///< called before each row
};

/// Measures all rows in this process, in about a minute on one core. A failed measurement gives an entry with NaN,
/// which does not pass, and the reason. Throws BadInput (unknown row, suggests the nearest; missing models) and
/// sim::InvalidSituation.
Certificate measure_certificate(const CertificateInput& input, const CertifyOptions& options);

}  // namespace tumble::scenarios
