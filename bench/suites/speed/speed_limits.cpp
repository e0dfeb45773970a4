// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/machine/machine.h"
#include "bench/suites/speed/speed_parts.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {

namespace {

// Float32 operations of a node update of the CPU's leapfrog in mild states (src/solver/cpu/simd/kernels.cpp):
// additions, subtractions and multiplications; a fused multiply-add is two. Comparisons, selections and loads do not
// count.
//   spring  w 3, w + 2d 1 or 2, w.(w + 2d) 5, q 1, d + w 1 or 2, phi 10, k q phi 2, force 6
// dashpot, if nodes are predicted 6
// node    acceleration 6, velocity 12 + 3, displacement 3 + 3, distance 5, speed 5
constexpr double kAxialFlop = 29, kDiagonalFlop = 31, kNodeFlop = 37, kPredictedFlop = 6;
constexpr double kFlop = 6 * kAxialFlop + 12 * kDiagonalFlop + kNodeFlop;
constexpr double kFlopWithDashpot = kFlop + kPredictedFlop;
// Instructions for these operations on whole vectors: operations on registers only, fused ones counted once, with
// comparisons and selections (four per spring: whether it exists, and whether it is the most strained). The rest of the
// peak is not reachable even without other work.
constexpr double kInstructions = 6 * 23 + 12 * 25 + 35;
// Bytes of a node update: u and v read and written, 1/m read. With a dashpot, also u and v read before, and the
// predicted ones written and read. 18 stiffnesses in bricks with a surface or a cut.
constexpr double kBytes = 4 * 12 + 4, kPredictedBytes = 4 * 12, kStiffnessBytes = 18 * 4;

constexpr double kGiga = 1e-9;

Limits hostLimits(int threads, bool short_form) {
  return {copyRate(threads, short_form ? 64 : 512), fmaRate(threads, short_form ? 0.1 : 1)};
}

Limits gpuLimits(bool short_form) {
  return {gpuCopyRate(short_form ? 32 : 256), gpuFmaRate(short_form ? 0.1 : 1)};
}

void addMachine(Table& table, const std::string& of, const std::string& with, const Limits& limits) {
  table.add({of, with, kGiga * limits.copy, kGiga * limits.fma, limits.fma / limits.copy});
}

/// Returns the share of nodes in bricks that are not full of whole springs.
double roughShare(const Model& model) {
  const Lattice& lattice = model.bodies[0].lattice;
  const auto whole = [&](uint32_t slot) {
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
      if (springCount(lattice.nodes[slot], s) != (isAxial(s) ? 4u : 2u)) return false;
    }
    return true;
  };
  size_t rough = 0, in_brick = 0, whole_in_brick = 0;
  for (size_t i = 0; i < lattice.active_slots.size(); ++i) {
    const uint32_t slot = lattice.active_slots[i];
    ++in_brick;
    whole_in_brick += whole(slot) ? 1 : 0;
    if (i + 1 < lattice.active_slots.size() && lattice.active_slots[i + 1] / 64 == slot / 64) continue;
    if (whole_in_brick < layout::kBrickSlots) rough += in_brick;
    in_brick = whole_in_brick = 0;
  }
  return static_cast<double>(rough) / static_cast<double>(lattice.active_slots.size());
}

}  // namespace

Work workOf(const Model& model, double dashpot) {
  const bool has = dashpot > 0;
  return {has ? kFlopWithDashpot : kFlop, kBytes + (has ? kPredictedBytes : 0) + kStiffnessBytes * roughShare(model)};
}

MachineLimits measureLimits(Report& report) {
  report.stage("copies and multiply-adds");
  const int threads = processors();
  const MachineLimits out{hostLimits(1, report.isShort()), hostLimits(threads, report.isShort())};
  Table table("this machine", {{"of"},
                               {"with"},
                               {"copy (read + write)", "GB/s", 3},
                               {"multiply-add", "GFLOP/s", 3},
                               {"balance", "flop/byte", 3}});
  addMachine(table, "processor, 1 thread", fmaTarget(), out.one);
  addMachine(table, "processor, " + std::to_string(threads) + " threads", fmaTarget(), out.all);
  if (report.context()) addMachine(table, "OpenGL", report.context()->renderer(), gpuLimits(report.isShort()));
  report.add(table, "machine");
  report.note(
      "Of " + Cell(kFlop).text(4) + " operations (fused ones count twice) in " + Cell(kInstructions).text(4) +
      " instructions, so arithmetic alone cannot exceed " + Cell(kFlop / (2 * kInstructions)).text(2) +
      " of the multiply-add rate. Copies are from main memory; data that fit in caches may exceed their rate.\n");
  return out;
}

}  // namespace viscera::bench
