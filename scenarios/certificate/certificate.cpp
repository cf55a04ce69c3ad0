// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/certificate/certificate.hpp"

#include <fmt/format.h>

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
  } catch (const std::exception& error) {  // a failed simulation is a result
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
      throw BadInput(fmt::format("no check of the simulation has the name '{}'{}", name, suggestion(name, known)));
    }
  }
  return selected;
}

}  // namespace

std::span<const CertificateRow> certificate_rows() {
  static const std::array kRows = {
      CertificateRow{"free_flight", "checks that energy and angular momentum are constant in free flight",
                     as_certified<certify_free_flight>},
      CertificateRow{"flight_force",
                     "checks that an ideal accelerometer at the centre of mass reads zero in free flight",
                     as_certified<certify_flight_force>},
      CertificateRow{"free_fall", "compares the duration of a free fall with the analytic solution",
                     as_certified<certify_free_fall>},
      CertificateRow{"rolling",
                     "checks the rolling constraint while a sphere grips a plane or the ground of a scenario",
                     as_certified<certify_rolling>},
      CertificateRow{"slip_to_grip", "compares the time until a sliding sphere grips with the analytic solution",
                     as_certified<certify_slip_to_grip>},
      CertificateRow{"impact",
                     "measures how the peak force of impacts depends on the time step and the contact stiffness",
                     as_certified<certify_impact>},
      CertificateRow{"lidar_range", "compares lidar ranges with analytic distances to the surfaces",
                     as_certified<certify_lidar_range>},
      CertificateRow{"lidar_rays", "compares lidar ranges with MuJoCo's mj_ray", as_certified<certify_lidar_rays>},
      CertificateRow{"imu_noise", "compares the noise of simulated IMUs at rest with the data sheets of the IMUs",
                     as_certified<certify_imu_noise>},
      CertificateRow{"tilted_rail",
                     "compares saturated readings of simulated IMUs with the saturation limits that the simulation "
                     "applies to each sensing element",
                     as_certified<certify_tilted_rail>},
      CertificateRow{"real_rails",
                     "compares the saturation limits of two real gyros with the saturation limits of simulated gyros",
                     as_certified<certify_real_rails>},
      CertificateRow{"pendulum",
                     "compares energy, periods and specific force of the simulated pendulum with Lagrange's equations",
                     as_certified<certify_pendulum>},
      CertificateRow{"digests",
                     "checks that recordings have equal digests for any number of threads, any order of the simulated "
                     "runs, and a restarted program",
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
