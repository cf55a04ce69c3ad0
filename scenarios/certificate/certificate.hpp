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

/// One measured number of the certificate, held to its bounds.
struct CertificateEntry {
  std::string row;      ///< what was measured: "free_flight_energy"
  std::string subject;  ///< on what: "rig", "hill", "mti30 gyro"
  std::string law;      ///< what it is held to, one sentence
  std::string unit;     ///< "1" when dimensionless
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;                                             ///< both bounds belong to the accepted values
  std::string note;                                              ///< why there is no value; empty otherwise
  bool passes() const { return value >= low && value <= high; }  ///< NaN does not
  bool operator==(const CertificateEntry&) const = default;
};

/// Measured proof of how far this build is from physics and from its data sheets.
struct Certificate {
  std::string build;  ///< build_id()
  std::vector<CertificateEntry> entries;
  bool passes() const;  ///< every entry does, and there is one
  bool operator==(const Certificate&) const = default;
};

/// What the rows measure on.
struct CertificateInput {
  DataRoot data;
  std::filesystem::path program;  ///< the program `tumble`, started anew for the digest after a restart
};

/// A row of the certificate, self-describing; one file and one line of registration each. `measure` with the set-up
/// that the certificate has; rows.hpp has the same with a set-up of the caller's.
struct CertificateRow {
  std::string name;
  std::string doc;
  std::vector<CertificateEntry> (*measure)(const CertificateInput& input);
};

/// All rows, in the order of the certificate.
std::span<const CertificateRow> certificate_rows();

struct CertifyOptions {
  std::vector<std::string> rows;            ///< names; empty: all
  const std::atomic<bool>* stop = nullptr;  ///< set it to end after the row at hand: what is there is returned
  std::function<void(const CertificateRow&, double elapsed_s)> on_row;  ///< before each row
};

/// Measures row by row, in this process, within about a minute of one core. A row that cannot be measured is an entry
/// without a value (NaN, which does not pass) and with the reason. Throws BadInput (unknown row, nearest named; no such
/// models) and sim::InvalidSituation.
Certificate measure_certificate(const CertificateInput& input, const CertifyOptions& options);

}  // namespace tumble::scenarios
