// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>

namespace viscera::python {

namespace py = pybind11;

/// Memory that NumPy reads by the buffer protocol. The module calls NumPy as Python code only. It does not depend on
/// NumPy's binary interface and works with versions 1 and 2.
struct Memory {
  const void* first = nullptr;
  py::ssize_t item_bytes = 0;
  std::string format;  ///< format of the buffer protocol
  std::vector<py::ssize_t> shape, strides_bytes;
  py::object owner;  ///< object that stays alive as long as the memory is used
};

/// Binds Memory. Call it before any function returns an array.
void bindMemory(py::module_& module);

/// Returns a read-only numpy.ndarray of the memory.
py::object arrayOf(Memory memory);

/// Returns a writable numpy.ndarray of float64 with these numbers.
py::object arrayOf(std::initializer_list<double> numbers);

/// Returns numpy.asarray(given, dtype). @param dtype  "float64", or empty: the type of `given`
/// @throws py::error_already_set  an exception of NumPy
py::object asArray(const py::object& given, const char* dtype);

/// An array of one type in C order, for reading.
template <class T>
class Given {
 public:
  Given() = default;
  /// @throws py::error_already_set  an exception of NumPy, if values do not convert
  Given(const py::object& given, const char* dtype) : array_(asArray(given, dtype)), info_(array_.request()) {}

  py::ssize_t ndim() const { return info_.ndim; }
  py::ssize_t size() const { return info_.size; }
  const std::vector<py::ssize_t>& shape() const { return info_.shape; }
  py::ssize_t shape(py::ssize_t axis) const { return info_.shape[static_cast<size_t>(axis)]; }
  const T* data() const { return static_cast<const T*>(info_.ptr); }
  /// Returns the address of an element. @param at  index along each axis
  template <class... Index>
  const T* data(Index... at) const {
    py::ssize_t place = 0;
    size_t axis = 0;
    ((place = place * info_.shape[axis++] + static_cast<py::ssize_t>(at)), ...);
    return data() + place;
  }
  template <class... Index>
  T at(Index... index) const {
    return *data(index...);
  }

 private:
  py::buffer array_ = py::reinterpret_borrow<py::buffer>(py::none());
  py::buffer_info info_;
};

/// Returns a read-only view without a copy; `owner` lives as long as the array.
/// @param strides  [bytes]
template <class T>
py::object view(const T* data, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides, py::handle owner) {
  return arrayOf({data, sizeof(T), py::format_descriptor<T>::format(), std::move(shape), std::move(strides),
                  py::reinterpret_borrow<py::object>(owner)});
}

/// Returns a view of consecutive rows of `width` numbers.
template <class T>
py::object rows(const std::vector<T>& values, py::ssize_t width, py::handle owner) {
  const auto size = static_cast<py::ssize_t>(sizeof(T));
  return view(values.data(), {static_cast<py::ssize_t>(values.size()) / width, width}, {width * size, size}, owner);
}

/// Returns an array that takes over a vector.
template <class T>
py::object given(std::vector<T>&& values, py::ssize_t width) {
  auto* kept = new std::vector<T>(std::move(values));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<T>*>(p); });
  const py::object all = rows(*kept, width, owner);
  return width > 1 ? all : all.attr("ravel")();
}

}  // namespace viscera::python
