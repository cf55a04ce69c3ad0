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
  std::string row;      ///< measured quantity: "free_flight_energy"
  std::string subject;  ///< measured object: "rig", "hill", "mti30 gyro"
  std::string law;      ///< physical law or specification, in one sentence
  std::string unit;     ///< "1" if dimensionless
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;                                             ///< both bounds are inclusive
  std::string note;                                              ///< reason why `value` is missing; otherwise empty
  bool passes() const { return value >= low && value <= high; }  ///< false for NaN
  bool operator==(const CertificateEntry&) const = default;
};

/// Certificate contains the measured deviations of this build's simulation from physical laws and sensor data sheets.
struct Certificate {
  std::string build;  ///< build_id()
  std::vector<CertificateEntry> entries;
  bool passes() const;  ///< at least one entry exists, and all entries pass
  bool operator==(const Certificate&) const = default;
};

/// CertificateInput contains the data files and the program that the certificate's measurements need.
struct CertificateInput {
  DataRoot data;
  std::filesystem::path program;  ///< the program `tumble`, which computes a digest in a new process
};

/// CertificateRow registers one measurement that checks the simulation. Each measurement has its own source file and
/// one registration line. `measure` uses the default settings; rows.hpp declares functions with settings.
struct CertificateRow {
  std::string name;
  std::string doc;
  std::vector<CertificateEntry> (*measure)(const CertificateInput& input);
};

/// Returns all registered measurements that check the simulation, in order.
std::span<const CertificateRow> certificate_rows();

struct CertifyOptions {
  std::vector<std::string> rows;            ///< names of the measurements; empty: all
  const std::atomic<bool>* stop = nullptr;  ///< the caller sets it to stop after the current measurement
  std::function<void(const CertificateRow&, double elapsed_s)> on_row;  ///< called before each measurement
};

/// Runs the measurements that check the simulation, in this process. All measurements take about a minute on one core.
/// If a measurement cannot be made, its entry contains the reason and the value NaN, and does not pass. Throws BadInput
/// for missing models or an unknown name; the message suggests the nearest name. Throws sim::InvalidSituation if a
/// situation cannot be simulated.
Certificate measure_certificate(const CertificateInput& input, const CertifyOptions& options);

}  // namespace tumble::scenarios
