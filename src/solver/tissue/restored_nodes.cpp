// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/tissue/restored_nodes.h"

#include <string>

#include "viscera/layout/limits.h"

namespace viscera {

namespace {

using layout::NodeBits;

/// Returns whether every field of `width` bits within `mask` is at most that of `whole`.
bool noneLarger(uint32_t bits, uint32_t whole, uint32_t mask, uint32_t width) {
  const uint32_t field = (1U << width) - 1;
  for (uint32_t shift = 0; (mask >> shift) != 0; shift += width) {
    if (((bits & mask) >> shift & field) > ((whole & mask) >> shift & field)) return false;
  }
  return true;
}

/// Returns the name of the part of a node that does not fit this tissue; nullptr if all fits.
const char* foreignPart(NodeBits bits, NodeBits whole, bool network) {
  constexpr uint32_t kMayChange = layout::kAxialMask | layout::kGrabMask | layout::kSeveredBit | layout::kCellBit;
  constexpr uint32_t kAxialWidth = 3, kDiagonalWidth = 2;
  if (bits.hi >> layout::kBodyShift != whole.hi >> layout::kBodyShift) return "belongs to another body";
  if ((bits.lo & ~kMayChange) != (whole.lo & ~kMayChange)) return "has another mass or another support";
  if ((bits.lo & layout::kCellBit) > (whole.lo & layout::kCellBit)) return "has a cell that the tissue does not have";
  if (((bits.lo & layout::kGrabMask) >> layout::kGrabShift) > layout::kMaxStyluses)
    return "is held by a stylus that does not exist";
  const bool axial = network ? (bits.lo & layout::kValenceMask) <= (whole.lo & layout::kValenceMask)
                             : noneLarger(bits.lo, whole.lo, layout::kAxialMask, kAxialWidth);
  if (!axial || !noneLarger(bits.hi, whole.hi, layout::kDiagonalMask, kDiagonalWidth))
    return "has a spring that the tissue does not have";
  return nullptr;
}

}  // namespace

void requireNodesOf(const std::vector<NodeBits>& whole, const std::vector<layout::BodyParams>& bodies,
                    const std::vector<NodeBits>& restored, const Archive& archive) {
  for (size_t slot = 0; slot < whole.size(); ++slot) {
    const bool network = bodies[whole[slot].hi >> layout::kBodyShift].connections == layout::kNetwork;
    const char* const foreign = foreignPart(restored[slot], whole[slot], network);
    if (foreign) archive.require(false, "node " + std::to_string(slot) + " " + foreign);
  }
}

}  // namespace viscera
