// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include "scenarios/certificate/certificate.hpp"

namespace tumble::scenarios {

class Results;

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

/// The certificate of this build if `results` or the store hold it, and puts it into `results`; measures nothing.
std::optional<Certificate> known_certificate(Results& results, const CertificateStore& store);

/// Puts the certificate of this build into `results` unless they hold it: out of the store, or measured now and kept in
/// both. Returns it. A certificate whose measuring was stopped has no entries and is kept nowhere. Throws as
/// measure_certificate does.
Certificate certify_results(Results& results, const CertificateStore& store, const CertificateInput& input,
                            const CertifyOptions& options);

}  // namespace tumble::scenarios
