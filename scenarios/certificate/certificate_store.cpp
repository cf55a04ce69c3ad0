// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/certificate/certificate_store.hpp"

#include <array>
#include <fstream>
#include <sstream>

#include "scenarios/certificate/certificate_text.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/sweep/build_id.hpp"
#include "scenarios/sweep/data_digest.hpp"
#include "scenarios/sweep/outcome.hpp"
#include "scenarios/sweep/results.hpp"

namespace tumble::scenarios {

namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  std::string line;
  while (std::getline(file, line)) {
    if (line.starts_with("model name")) return line;
  }
  return "unknown";
}

bool stopped(const CertifyOptions& options) {
  return options.stop != nullptr && options.stop->load();
}

}  // namespace

CertificateStore::CertificateStore(std::filesystem::path folder, const DataRoot& data) {
  if (folder.empty()) return;
  const std::array<std::string, 3> key = {build_id(), data_digest(data), processor()};
  file_ = folder / ("certificate_" + digest_of_texts(key) + ".json");
}

std::optional<Certificate> CertificateStore::find() const {
  std::ifstream file(file_);
  if (file_.empty() || !file) return std::nullopt;
  std::ostringstream text;
  text << file.rdbuf();
  try {
    Certificate certificate = certificate_from_json(text.str(), file_.string());
    if (certificate.build == build_id() && !certificate.entries.empty()) return certificate;
  } catch (const BadInput&) {  // cut off or by another hand: measured again
  }
  return std::nullopt;
}

void CertificateStore::keep(const Certificate& certificate) const {
  if (file_.empty()) return;
  std::error_code ignored;
  std::filesystem::create_directories(file_.parent_path(), ignored);
  try {
    replace_file(file_, to_json(certificate));
  } catch (const BadInput&) {  // a cache that cannot be written is none
  }
}

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
