// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/certified_results.hpp"

#include <utility>

#include "scenarios/provenance/build_id.hpp"

namespace tumble::scenarios {

namespace {

bool stopped(const CertifyOptions& options) {
  return options.stop != nullptr && options.stop->load();
}

}  // namespace

std::optional<Certificate> known_certificate(Results& results, const CertificateStore& store) {
  for (Certificate& known : results.certificates()) {
    if (known.build == build_id()) return std::move(known);
  }
  std::optional<Certificate> certificate = store.find();
  if (certificate) results.store(*certificate);
  return certificate;
}

Certificate certify_results(Results& results, const CertificateStore& store, const CertificateInput& input,
                            const CertifyOptions& options) {
  if (std::optional<Certificate> known = known_certificate(results, store)) return *std::move(known);
  Certificate certificate = measure_certificate(input, options);
  if (stopped(options)) return {build_id(), {}};
  store.keep(certificate);
  results.store(certificate);
  return certificate;
}

}  // namespace tumble::scenarios
