// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Marks what the library exports: all that is declared in a block of namespace viscera with this mark. Everything else
/// is hidden (cmake/library.cmake). Classes have it too: GCC takes the visibility of a class from its first
/// declaration, which may be in an internal header.
#define VISCERA_PUBLIC [[gnu::visibility("default")]]
