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

/// saved_edits.hpp corrupts saved states by edits from a file: the states are created at run time, so that a seed stays
/// valid when they change.
namespace tumble::fuzz {

using Bytes = std::vector<std::byte>;

/// Edits contains a letter for the class, then edits of six bytes each: what (modulo 5), where (4 bytes, little-endian,
/// modulo the size), by which byte.
struct Edits {
  char letter = 0;                ///< first letter of the file, in upper case
  bool use_saved_params = false;  ///< use the parameters stored in the bytes, after the edits
  std::string text;

  /// Length and checksum are recomputed, because a fuzzer would never find them. Throws BadInput if an edit is
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
