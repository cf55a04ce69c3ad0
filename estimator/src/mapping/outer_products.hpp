// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace tumble::mapping {

/// OuterProducts computes the same sums of outer products as Eigen's rankUpdate, bit for bit, but on the heap. Eigen's
/// rankUpdate needs 86 KiB of stack for 128 columns of 28 numbers.
template <int Rows, int Columns>
class OuterProducts {
 public:
  using Matrix = Eigen::Matrix<double, Rows, Rows>;

  static std::unique_ptr<OuterProducts> make_unique_products() {
    return std::unique_ptr<OuterProducts>(new OuterProducts);
  }
  OuterProducts(const OuterProducts&) = delete;  // the blocks contain addresses of this object
  OuterProducts& operator=(const OuterProducts&) = delete;

  Eigen::Matrix<double, Rows, Columns> columns;

  /// For each of the first `count` columns v of `columns`, adds the outer product v v^T to the lower triangle of `sum`.
  /// Only the first `size` rows of each column are used.
  void add_products_to(int size, int count, Matrix& sum) {
    namespace e = Eigen::internal;
    e::general_matrix_matrix_triangular_product<Eigen::Index, double, Eigen::ColMajor, false, double, Eigen::RowMajor,
                                                false, Eigen::ColMajor, 1, Eigen::Lower>::run(size, count,
                                                                                              columns.data(), Rows,
                                                                                              columns.data(), Rows,
                                                                                              sum.data(), 1, Rows, 1.0,
                                                                                              blocks_);
  }

 private:
  using Blocks = Eigen::internal::gemm_blocking_space<Eigen::ColMajor, double, double, Rows, Rows, Columns>;

  OuterProducts() = default;

  Blocks blocks_{Rows, Rows, Columns, 1, false};
};

/// The pool of work buffers grows to the number of threads that use it at the same time.
template <class Work>
class WorkspacePool {
 public:
  std::unique_ptr<Work> acquire() {
    const std::lock_guard lock(mutex_);
    if (free_workspaces_.empty()) return Work::make_unique_products();
    std::unique_ptr<Work> out = std::move(free_workspaces_.back());
    free_workspaces_.pop_back();
    return out;
  }
  void release(std::unique_ptr<Work> work) {
    const std::lock_guard lock(mutex_);
    free_workspaces_.push_back(std::move(work));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Work>> free_workspaces_;
};

}  // namespace tumble::mapping
