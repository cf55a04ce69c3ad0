// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "scenarios/certificate/certificate_store.hpp"
#include "scenarios/sweep/results.hpp"

namespace tumble::scenarios {

/// Returns this build's certificate if `results` or the store contain it, and copies it to `results`; measures nothing.
std::optional<Certificate> known_certificate(Results& results, const CertificateStore& store);

/// Adds this build's certificate to `results` if it is missing: from the store, or measured now and saved in both.
/// Returns the certificate. An interrupted measurement gives no entries and is not saved. Throws the exceptions of
/// measure_certificate.
Certificate certify_results(Results& results, const CertificateStore& store, const CertificateInput& input,
                            const CertifyOptions& options);

}  // namespace tumble::scenarios
