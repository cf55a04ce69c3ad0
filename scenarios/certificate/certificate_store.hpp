// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include "scenarios/certificate/certificate.hpp"

namespace tumble::scenarios {

/// Certificates kept in a folder, one file per build, data and machine (model of the processor), so that each is
/// measured once. Trouble with the folder is no error: nothing is kept then.
class CertificateStore {
 public:
  /// An empty path keeps nothing.
  CertificateStore(std::filesystem::path folder, const DataRoot& data);

  std::optional<Certificate> find() const;
  void keep(const Certificate& certificate) const;

 private:
  std::filesystem::path file_;
};

}  // namespace tumble::scenarios
