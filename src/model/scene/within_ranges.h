// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>

#include "model/scene/scene_fields.h"

namespace viscera {

/// Field visitor that clamps numbers to the ranges of their keys.
class IntoRange {
 public:
  void number(const char*, double& value, Range range, const char*, const char*) {
    value = std::clamp(value, range.min, range.max);
  }
  void vector(const char*, Vector3d& value, Range range, const char*, const char*) {
    value = value.cwiseMax(range.min).cwiseMin(range.max);
  }
  template <class Struct>
  void group(const char*, Struct& value, const char*) {
    visitFields(*this, value);
  }
  void integer(const char*, int&, Range, const char*) {}
  void text(const char*, std::string&, const char*) {}
  void boolean(const char*, bool&, const char*) {}
  template <class E>
  void choice(const char*, E&, const Choices<E>&, const char*) {}
};

/// Returns a struct of keys with each number clamped to its key's range.
template <class Struct>
Struct withinRanges(Struct keys) {
  IntoRange into_range;
  visitFields(into_range, keys);
  return keys;
}

}  // namespace viscera
