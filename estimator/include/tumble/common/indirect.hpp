// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <utility>

namespace tumble {

/// Indirect stores a value on the heap. A copy of an Indirect copies the value, and a constant Indirect gives access to
/// a constant value, like std::indirect of C++26. T may be an incomplete type where an Indirect is a member. The source
/// file that uses the following functions, or instantiates them explicitly, needs the complete type. A moved-from
/// Indirect has no value until it is assigned.
template <class T>
class Indirect {
 public:
  /// Constructs the value without arguments.
  Indirect();
  explicit Indirect(std::unique_ptr<T> value);
  Indirect(const Indirect& other);
  Indirect(Indirect&& other) noexcept;
  Indirect& operator=(const Indirect& other);
  Indirect& operator=(Indirect&& other) noexcept;
  ~Indirect();

  T& operator*() { return *value_; }
  const T& operator*() const { return *value_; }
  T* operator->() { return value_.get(); }
  const T* operator->() const { return value_.get(); }

 private:
  std::unique_ptr<T> value_;
};

// not inline, so that an `extern template` suppresses the instantiation with an incomplete type
template <class T>
Indirect<T>::Indirect() : value_(std::make_unique<T>()) {}
template <class T>
Indirect<T>::Indirect(std::unique_ptr<T> value) : value_(std::move(value)) {}
template <class T>
Indirect<T>::Indirect(const Indirect& other) : value_(std::make_unique<T>(*other.value_)) {}
template <class T>
Indirect<T>::Indirect(Indirect&& other) noexcept : value_(std::move(other.value_)) {}
template <class T>
Indirect<T>& Indirect<T>::operator=(const Indirect& other) {
  return *this = Indirect(other);
}
template <class T>
Indirect<T>& Indirect<T>::operator=(Indirect&& other) noexcept {
  value_ = std::move(other.value_);
  return *this;
}
template <class T>
Indirect<T>::~Indirect() = default;

}  // namespace tumble
