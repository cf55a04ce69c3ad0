// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/certificate/certificate.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "scenarios/certificate/rows.hpp"
#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/processes/process.hpp"
#include "scenarios/provenance/build_id.hpp"
#include "sim/parameters.hpp"

namespace tumble::scenarios {

namespace {

/// Registers a measurement with the certificate's default settings.
template <auto kMeasure>
std::vector<CertificateEntry> as_certified(const CertificateInput& input) {
  return kMeasure(input, {});
}

std::vector<CertificateEntry> measure_row(const CertificateRow& row, const CertificateInput& input) {
  std::string reason = "no entry";
  try {
    std::vector<CertificateEntry> entries = row.measure(input);
    if (!entries.empty()) return entries;
  } catch (const BadInput&) {
    throw;
  } catch (const sim::InvalidSituation&) {
    throw;
  } catch (const std::exception& error) {  // a failing simulation is a valid result
    reason = error.what();
  }
  return {{row.name, "", row.doc, "1", std::nan(""), 0.0, 0.0, reason}};
}

std::vector<const CertificateRow*> select(const std::vector<std::string>& names) {
  std::vector<const CertificateRow*> selected;
  std::vector<std::string> known;
  for (const CertificateRow& row : certificate_rows()) {
    known.push_back(row.name);
    if (names.empty() || std::find(names.begin(), names.end(), row.name) != names.end()) selected.push_back(&row);
  }
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw BadInput("the certificate has no row '" + name + "'" + suggestion(name, known));
    }
  }
  return selected;
}

}  // namespace

std::span<const CertificateRow> certificate_rows() {
  static const std::array kRows = {
      CertificateRow{"free_flight", "energy and angular momentum in free flight", as_certified<certify_free_flight>},
      CertificateRow{"flight_force", "specific force at the centre of mass in flight",
                     as_certified<certify_flight_force>},
      CertificateRow{"free_fall", "duration of a free fall", as_certified<certify_free_fall>},
      CertificateRow{"rolling", "rolling constraint on the plane and on each ground", as_certified<certify_rolling>},
      CertificateRow{"slip_to_grip", "time from slip to grip of a sliding sphere", as_certified<certify_slip_to_grip>},
      CertificateRow{"impact", "sensitivity of impact peaks to the time step and the contact stiffness",
                     as_certified<certify_impact>},
      CertificateRow{"lidar_range", "lidar range error against analytic surfaces", as_certified<certify_lidar_range>},
      CertificateRow{"lidar_rays", "lidar range error against MuJoCo's mj_ray", as_certified<certify_lidar_rays>},
      CertificateRow{"imu_noise", "noise of the IMUs at rest against their data sheets",
                     as_certified<certify_imu_noise>},
      CertificateRow{"tilted_rail",
                     "planes of the clipped readings of tilted sensing elements against the drawn planes",
                     as_certified<certify_tilted_rail>},
      CertificateRow{"real_rails",
                     "rail planes of real gyros against those of simulated devices and their distribution",
                     as_certified<certify_real_rails>},
      CertificateRow{"pendulum", "energy, periods and specific force of the pendulum against Lagrange's equations",
                     as_certified<certify_pendulum>},
      CertificateRow{"digests", "equal digests for all numbers of threads, orders of draws and restarts",
                     as_certified<certify_digests>},
  };
  return kRows;
}

bool Certificate::passes() const {
  return !entries.empty() &&
         std::all_of(entries.begin(), entries.end(), [](const CertificateEntry& entry) { return entry.passes(); });
}

Certificate measure_certificate(const CertificateInput& input, const CertifyOptions& options) {
  Certificate certificate;
  certificate.build = build_id();
  const double start_s = now_s();
  for (const CertificateRow* row : select(options.rows)) {
    if (options.stop != nullptr && options.stop->load()) break;
    if (options.on_row) options.on_row(*row, now_s() - start_s);
    for (CertificateEntry& entry : measure_row(*row, input)) certificate.entries.push_back(std::move(entry));
  }
  return certificate;
}

}  // namespace tumble::scenarios
