// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

namespace viscera::python {

namespace py = pybind11;

/// A view without a copy: `owner` lives as long as the array, and NumPy does not let it be written.
/// @param strides  in bytes
template <class T>
py::array view(const T* data, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides, py::handle owner) {
  py::array out(py::dtype::of<T>(), std::move(shape), std::move(strides), data, owner);
  py::detail::array_proxy(out.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return out;
}

/// Rows of `width` numbers, one behind the other.
template <class T>
py::array rows(const std::vector<T>& values, py::ssize_t width, py::handle owner) {
  const auto size = static_cast<py::ssize_t>(sizeof(T));
  return view(values.data(), {static_cast<py::ssize_t>(values.size()) / width, width}, {width * size, size}, owner);
}

/// The numbers of a vector that is given away: the array owns them.
template <class T>
py::array given(std::vector<T>&& values, py::ssize_t width) {
  auto* kept = new std::vector<T>(std::move(values));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<T>*>(p); });
  const py::array all = rows(*kept, width, owner);
  return width > 1 ? all : py::array(all.attr("ravel")());
}

}  // namespace viscera::python
