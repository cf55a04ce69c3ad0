// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <utility>

namespace tumble {

/// HeapValue stores a value on the heap. A copy of a HeapValue copies the value, and a constant HeapValue gives access
/// to a constant value, like std::indirect of C++26. T may be an incomplete type where a HeapValue is a member. The
/// source file that uses the following functions, or instantiates them explicitly, needs the complete type. A
/// moved-from HeapValue has no value until it is assigned.
template <class T>
class HeapValue {
 public:
  /// Constructs the value without arguments.
  HeapValue();
  explicit HeapValue(std::unique_ptr<T> value);
  HeapValue(const HeapValue& other);
  HeapValue(HeapValue&& other) noexcept;
  HeapValue& operator=(const HeapValue& other);
  HeapValue& operator=(HeapValue&& other) noexcept;
  ~HeapValue();

  T& operator*() { return *value_; }
  const T& operator*() const { return *value_; }
  T* operator->() { return value_.get(); }
  const T* operator->() const { return value_.get(); }

 private:
  std::unique_ptr<T> value_;
};

// The following functions are not inline, because an `extern template` declaration does not prevent the instantiation
// of inline functions. The instantiation fails in files in which T is incomplete.
template <class T>
HeapValue<T>::HeapValue() : value_(std::make_unique<T>()) {}
template <class T>
HeapValue<T>::HeapValue(std::unique_ptr<T> value) : value_(std::move(value)) {}
template <class T>
HeapValue<T>::HeapValue(const HeapValue& other) : value_(std::make_unique<T>(*other.value_)) {}
template <class T>
HeapValue<T>::HeapValue(HeapValue&& other) noexcept : value_(std::move(other.value_)) {}
template <class T>
HeapValue<T>& HeapValue<T>::operator=(const HeapValue& other) {
  return *this = HeapValue(other);
}
template <class T>
HeapValue<T>& HeapValue<T>::operator=(HeapValue&& other) noexcept {
  value_ = std::move(other.value_);
  return *this;
}
template <class T>
HeapValue<T>::~HeapValue() = default;

}  // namespace tumble
