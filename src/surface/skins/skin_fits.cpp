// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/skins/skin_fits.h"

#include <sstream>

#include "gpu/limits.h"
#include "viscera/layout/skin.h"
#include "viscera/math/error.h"

namespace viscera {

void requireSkinFits(size_t vertices, bool can_be_cut) {
  const size_t block_bytes = gpu::driverLimits().storage_block_bytes, room = can_be_cut ? kRoomForWounds : 1;
  const size_t most = block_bytes / sizeof(layout::SkinBinding) / room;
  if (vertices <= most) return;
  constexpr double kFacesPerVertex = 2, kMargin = 0.8;  // of a closed surface; seams double vertices
  std::ostringstream out;
  out << "the skins have " << vertices << " vertices, but this driver can show at most " << most;
  if (can_be_cut) out << " where tissue can be cut";
  out << " (GL_MAX_SHADER_STORAGE_BLOCK_SIZE = " << block_bytes
      << "). Set bodies[].skin_faces, in total over all bodies "
      << static_cast<size_t>(kMargin * kFacesPerVertex * static_cast<double>(most)) << " or less, or run without "
      << "pictures (--no-view)";
  throw GpuError(out.str());
}

}  // namespace viscera
