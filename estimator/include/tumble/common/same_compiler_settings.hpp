// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>

/// A program and the compiled library must use the same memory layout for Eigen's matrices and the standard library's
/// containers. A program with another layout, for example through EIGEN_MAX_STATIC_ALIGN_BYTES or _GLIBCXX_DEBUG, does
/// not link. The linker then reports CompilerSettingsCheck<...>::linked as missing.
namespace tumble::detail {

#ifdef _GLIBCXX_DEBUG
inline constexpr bool kCheckedContainers = true;
#else
inline constexpr bool kCheckedContainers = false;
#endif

#ifdef EIGEN_DEFAULT_TO_ROW_MAJOR
inline constexpr bool kRowMajor = true;
#else
inline constexpr bool kRowMajor = false;
#endif

template <int eigen_static_alignment, bool eigen_malloc_is_aligned, bool eigen_row_major, std::size_t eigen_index_bytes,
          bool checked_containers>
struct CompilerSettingsCheck {
  static const char link_time_check;
};

using CompiledHere = CompilerSettingsCheck<EIGEN_MAX_STATIC_ALIGN_BYTES, EIGEN_MALLOC_ALREADY_ALIGNED != 0, kRowMajor,
                                           sizeof(Eigen::Index), kCheckedContainers>;

template <>
const char CompiledHere::link_time_check;  // a declaration; src/common/same_compiler_settings.cpp has the definition

/// This reference to `link_time_check` makes the linker check each source file.
[[gnu::used]] static const char* const kSameCompilerSettings = &CompiledHere::link_time_check;

}  // namespace tumble::detail
