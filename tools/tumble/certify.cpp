// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "scenarios/certificate/certificate.hpp"
#include "scenarios/certificate/certificate_store.hpp"
#include "tools/tables/certificate_table.hpp"
#include "tools/tumble/interrupt.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

int certify(const Session& session, const std::vector<std::string>& rows) {
  const InterruptFlag interrupt;
  scenarios::CertifyOptions options;
  options.rows = rows;
  options.stop = &interrupt.raised();
  options.on_row = [&](const scenarios::CertificateRow& row, double elapsed_s) {
    session.note(fmt::format("{:5.1f} s  {}", elapsed_s, row.doc));
  };
  const scenarios::Certificate certificate =
      scenarios::measure_certificate({session.data(), session.program()}, options);
  session.print({certificate_table(certificate)}, nlohmann::json::parse(to_json(certificate)));
  if (interrupt.raised().load()) {
    std::fprintf(stderr, "tumble: stopped: the checks of the simulation are incomplete; run the command again\n");
    return kCheckFailed;
  }
  return certificate.passes() ? kDone : kCheckFailed;
}

}  // namespace

Action declare_certify(VerbOptions& verb, const Session& session) {
  auto rows = std::make_shared<std::vector<std::string>>();
  std::string known;
  for (const scenarios::CertificateRow& row : scenarios::certificate_rows()) known += " " + row.name;
  verb.add("--row", *rows,
           fmt::format("runs only this check of the simulation; repeat the option for more checks:{}", known))
      .one_at_a_time();
  return [&session, rows] { return certify(session, *rows); };
}

}  // namespace tumble::tools
