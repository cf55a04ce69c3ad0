// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "scenarios/certificate/certificate_store.hpp"
#include "scenarios/sweep/results.hpp"

namespace tumble::scenarios {

/// Returns this build's certificate if `results` or the store contains it, and copies it to `results`. The function
/// makes no measurement.
std::optional<Certificate> known_certificate(Results& results, const CertificateStore& store);

/// Adds this build's certificate to `results` if it is missing. The certificate comes from the store, or is measured
/// and then saved in the store and in `results`. Returns this build's certificate. If the measurement is interrupted,
/// the certificate has no entries and is not saved. Throws the exceptions of measure_certificate.
Certificate certify_results(Results& results, const CertificateStore& store, const CertificateInput& input,
                            const CertifyOptions& options);

}  // namespace tumble::scenarios
