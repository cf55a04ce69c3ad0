// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>

/// A program must lay out Eigen's matrices and the standard library's containers as the library was compiled to do,
/// else both read each other's memory wrongly. CMake's targets see to this. A program that changes it after all, by
/// EIGEN_MAX_STATIC_ALIGN_BYTES, EIGEN_DONT_VECTORIZE, _GLIBCXX_DEBUG or the like, does not link: the linker misses
/// CompiledAlike<...>::linked, whose arguments are what the program was compiled with.
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
struct CompiledAlike {
  static const char linked;
};

using CompiledHere = CompiledAlike<EIGEN_MAX_STATIC_ALIGN_BYTES, EIGEN_MALLOC_ALREADY_ALIGNED != 0, kRowMajor,
                                   sizeof(Eigen::Index), kCheckedContainers>;

/// Once per source of the program, so that each of them is checked.
[[gnu::used]] static const char* const kCompiledAlike = &CompiledHere::linked;

}  // namespace tumble::detail
