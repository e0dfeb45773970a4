// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "viscera/math/error.h"

namespace viscera {

/// Calls `make`. If memory does not suffice, throws an error that says what the memory was for.
/// @param what  what is made: "mesh file 'x.obj'"; or a function that returns it, called after `make` has failed
/// @throws Fault  of viscera/math/error.h, in place of std::bad_alloc and std::length_error
template <class Fault = Error, class What, class Make>
auto memoryFor(const What& what, Make make) -> decltype(make()) {
  const auto fault = [&what] {
    const std::string made = [&] {
      if constexpr (std::is_invocable_v<What>) {
        return what();
      } else {
        return std::string(what);
      }
    }();
    return Fault(made + ": not enough memory on this machine, or left for this program");
  };
  try {
    return make();
  } catch (const std::bad_alloc&) {
    throw fault();
  } catch (const std::length_error&) {  // more than the address space
    throw fault();
  }
}

}  // namespace viscera
