// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "cli/commands.h"
#include "viscera/gpu/context.h"

namespace viscera::cli {

int check(int device) {
  const gpu::Context context(device);
  for (const gpu::DeviceAttempt& attempt : context.attempts()) {
    std::cout << (attempt.taken ? "* " : "  ") << "device " << attempt.index << ": " << attempt.name << ": "
              << attempt.reason << '\n';
  }
  std::cout << "renderer: " << context.renderer() << "\nOpenGL:   " << context.version() << '\n';
  if (context.isSoftware())
    std::cout << "note:     software rasteriser: everything works, at a fraction of a GPU's speed\n";
  return 0;
}

}  // namespace viscera::cli
