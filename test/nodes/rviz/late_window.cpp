// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// For LD_PRELOAD: simulates that the X server does not have a window yet when its size is queried, which happens
// occasionally if one connection creates the window and another queries it. Writing to buffers of size zero ends the
// program. $VISCERA_LATE selects the window: 1 is rviz's own, 2 that of the first Image display.
#include <dlfcn.h>
#include <sys/mman.h>

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <set>

namespace {
constexpr size_t kPage = 4096;
constexpr size_t kMapped = size_t{64} << 20U;  // glibc maps such blocks separately, and does not access their contents
}  // namespace

extern "C" {

int XGetGeometry(void* display, unsigned long drawable, unsigned long* root, int* x, int* y, unsigned* width,
                 unsigned* height, unsigned* border, unsigned* depth) {
  static const auto next = reinterpret_cast<decltype(&XGetGeometry)>(dlsym(RTLD_NEXT, "XGetGeometry"));
  static const size_t late = std::strtoul(std::getenv("VISCERA_LATE"), nullptr, 10);
  static std::set<unsigned long> windows;
  const int known = next(display, drawable, root, x, y, width, height, border, depth);
  if (*width == 1) return known;  // rviz's hidden window
  if (!windows.insert(drawable).second || windows.size() != late) return known;
  std::fputs("a window came late\n", stderr);
  *width = 168;  // values that were observed on Mesa's stack
  *height = 0;
  return 0;
}

int posix_memalign(void** block, size_t alignment, size_t size) {
  static const auto next = reinterpret_cast<decltype(&posix_memalign)>(dlsym(RTLD_NEXT, "posix_memalign"));
  if (size != 0) return next(block, alignment, size);
  const int error = next(block, kPage, kMapped);
  return error != 0 ? error : mprotect(*block, kPage, PROT_NONE);
}
}
