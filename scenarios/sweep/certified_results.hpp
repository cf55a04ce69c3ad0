// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "scenarios/certificate/certificate_store.hpp"
#include "scenarios/sweep/results.hpp"

namespace tumble::scenarios {

/// The certificate of this build if `results` or the store hold it, and puts it into `results`; measures nothing.
std::optional<Certificate> known_certificate(Results& results, const CertificateStore& store);

/// Puts the certificate of this build into `results` unless they hold it: out of the store, or measured now and kept in
/// both. Returns it. A certificate whose measuring was stopped has no entries and is kept nowhere. Throws as
/// measure_certificate does.
Certificate certify_results(Results& results, const CertificateStore& store, const CertificateInput& input,
                            const CertifyOptions& options);

}  // namespace tumble::scenarios
