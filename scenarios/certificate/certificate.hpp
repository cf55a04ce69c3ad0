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

/// CertificateEntry is one measured quantity of the simulation, with its accepted range.
struct CertificateEntry {
  std::string row;      ///< quantity: "free_flight_energy"
  std::string subject;  ///< object: "rig", "hill", "mti30 gyro"
  std::string law;      ///< physical law or specification, one sentence
  std::string unit;     ///< "1" if dimensionless
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;                                             ///< both bounds are inclusive
  std::string note;                                              ///< reason for a missing value; else empty
  bool passes() const { return value >= low && value <= high; }  ///< false for NaN
  bool operator==(const CertificateEntry&) const = default;
};

/// Certificate contains the measured deviations of this build's simulation from physical laws and sensor data sheets.
struct Certificate {
  std::string build;  ///< build_id()
  std::vector<CertificateEntry> entries;
  bool passes() const;  ///< Returns true if there is at least one entry and all entries pass.
  bool operator==(const Certificate&) const = default;
};

/// CertificateInput contains the data files and the program that the certificate's measurements need.
struct CertificateInput {
  DataRoot data;
  std::filesystem::path program;  ///< the program `tumble`, started to check the digest in a new process
};

/// CertificateRow registers one measurement that checks the simulation. Each measurement has a separate source file and
/// one registration line. The function `measure` uses the default settings; rows.hpp declares versions with custom
/// settings.
struct CertificateRow {
  std::string name;
  std::string doc;
  std::vector<CertificateEntry> (*measure)(const CertificateInput& input);
};

/// Returns all registered measurements that check the simulation, in order.
std::span<const CertificateRow> certificate_rows();

struct CertifyOptions {
  std::vector<std::string> rows;            ///< names; empty: all
  const std::atomic<bool>* stop = nullptr;  ///< set by the caller to stop after the current row
  std::function<void(const CertificateRow&, double elapsed_s)> on_row;  ///< called before each row
};

/// Runs the measurements that check the simulation in this process, which takes about a minute on one core. If a
/// measurement fails, its entry contains the reason and the value NaN, which does not pass. Throws BadInput for missing
/// models or an unknown name; the message suggests the nearest name. Throws sim::InvalidSituation if a situation cannot
/// be simulated.
Certificate measure_certificate(const CertificateInput& input, const CertifyOptions& options);

}  // namespace tumble::scenarios
