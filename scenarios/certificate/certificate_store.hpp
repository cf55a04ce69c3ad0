// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include "scenarios/certificate/certificate.hpp"

namespace tumble::scenarios {

/// CertificateStore caches simulation checks in a folder, with one file per combination of build, data and processor
/// model.
class CertificateStore {
 public:
  CertificateStore(std::filesystem::path folder, const DataRoot& data);

  std::optional<Certificate> find() const;
  void keep(const Certificate& certificate) const;

 private:
  std::filesystem::path file_;
};

}  // namespace tumble::scenarios
