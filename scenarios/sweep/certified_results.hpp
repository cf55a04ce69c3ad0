// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "scenarios/certificate/certificate_store.hpp"
#include "scenarios/sweep/results.hpp"

namespace tumble::scenarios {

std::optional<Certificate> known_certificate(Results& results, const CertificateStore& store);

/// Returns the certificate (results of the simulation checks) of this build from `results` or `store`. If neither
/// `results` nor `store` contains the certificate, the function performs the checks, and saves the certificate in both
/// places. If the checks are interrupted, nothing is saved.
Certificate certify_results(Results& results, const CertificateStore& store, const CertificateInput& input,
                            const CertifyOptions& options);

}  // namespace tumble::scenarios
