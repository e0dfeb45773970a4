// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "python/arrays.h"

namespace viscera::python {

namespace {

py::module_ numpy() {
  return py::module_::import("numpy");
}

py::buffer_info infoOf(const Memory& memory) {
  static const double kNothing = 0;  // address of an array without elements
  const void* first = memory.first ? memory.first : &kNothing;
  return {const_cast<void*>(first),
          memory.item_bytes,
          memory.format,
          static_cast<py::ssize_t>(memory.shape.size()),
          memory.shape,
          memory.strides_bytes,
          true};
}

}  // namespace

void bindMemory(py::module_& module) {
  py::class_<Memory>(module, "_Memory", py::buffer_protocol(), "Memory that an array refers to.").def_buffer(&infoOf);
}

py::object arrayOf(Memory memory) {
  return numpy().attr("asarray")(py::cast(std::move(memory)));
}

py::object arrayOf(std::initializer_list<double> numbers) {
  py::list values;
  for (const double number : numbers) values.append(number);
  return numpy().attr("array")(values);
}

py::object asArray(const py::object& given, const char* dtype) {
  using namespace py::literals;
  if (!*dtype) return numpy().attr("asarray")(given);
  return numpy().attr("asarray")(given, "dtype"_a = dtype, "order"_a = "C");
}

}  // namespace viscera::python
