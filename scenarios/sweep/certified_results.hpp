// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "scenarios/certificate/certificate_store.hpp"
#include "scenarios/sweep/results.hpp"

namespace tumble::scenarios {

/// Returns this build's certificate if `results` or the store contain it, and stores it in `results`; measures nothing.
std::optional<Certificate> known_certificate(Results& results, const CertificateStore& store);

/// Stores this build's certificate in `results` if missing: from the store, or measured now and saved in both. Returns
/// the certificate. An interrupted measurement gives no entries and is not saved. Throws as measure_certificate does.
Certificate certify_results(Results& results, const CertificateStore& store, const CertificateInput& input,
                            const CertifyOptions& options);

}  // namespace tumble::scenarios
