// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "scenarios/certificate/certificate.hpp"

namespace tumble::scenarios {

/// CertificateStore caches certificates (results of simulation checks) in a folder, with one file per combination of
/// build, data and processor model.
class CertificateStore {
 public:
  CertificateStore(std::filesystem::path folder, const DataRoot& data);

  std::optional<Certificate> find() const;
  void keep(const Certificate& certificate) const;

 private:
  std::filesystem::path file_;
};

/// Converts a certificate to JSON: {"build", "verdict": "pass" | "fail", "entries": [{row, subject, law, unit, value,
/// low, high, verdict, note}]}. Non-finite numbers become null.
std::string to_json(const Certificate& certificate);

Certificate certificate_from_json(const std::string& text, const std::string& place);

}  // namespace tumble::scenarios
