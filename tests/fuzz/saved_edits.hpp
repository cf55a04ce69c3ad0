// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <tumble/common/status.hpp>
#include <vector>

#include "scenarios/errors.hpp"

/// Corrupts saved states by edits from a file. The states are generated here and not read from files, so that a seed
/// remains valid if the state format changes.
namespace tumble::fuzz {

using Bytes = std::vector<std::byte>;

/// A letter for the class, then edits of six bytes: kind (modulo 5), position (4 bytes, little-endian, modulo the
/// size), and value.
struct Edits {
  char letter = 0;                ///< first letter of the file, in upper case
  bool use_saved_params = false;  ///< use the parameters stored in the bytes, after the edits
  std::string text;

  /// Corrects length and checksum after the edits, because a fuzzer would not find them. Throws BadInput if an edit is
  /// incomplete.
  Bytes spoil(Bytes saved) const;
};
/// Throws BadInput if the file is empty.
Edits read_edits(const std::filesystem::path& file);

/// Loads a saved state with edits. Throws BadInput if the estimator rejects the state by a Status, or its parameters by
/// InvalidParams. An accepted state must give the same bytes when it is saved again, and must continue. `Kind` has
/// Estimator, params(), saved() and go_on().
template <class Kind>
void load_spoiled(const Edits& edits) {
  const auto refuse = [](const Status& status) {
    if (!status.ok()) throw scenarios::BadInput(status.message());
  };
  static const Bytes saved = Kind::saved();
  const Bytes bytes = edits.spoil(saved);
  typename Kind::Estimator::Params params = Kind::params();
  if (edits.use_saved_params) refuse(Kind::Estimator::saved_params(bytes, params));
  std::optional<typename Kind::Estimator> estimator;
  try {
    estimator.emplace(params);
  } catch (const InvalidParams& error) {
    throw scenarios::BadInput(error.what());
  }
  refuse(estimator->load(bytes));
  if (estimator->save() != bytes) throw std::logic_error("a state that was loaded is another one when it is saved");
  Kind::go_on(*estimator);
}

}  // namespace tumble::fuzz
