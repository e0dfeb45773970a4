// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/gpu/gpu_suite.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>

#include "bench/harness/machine/machine.h"
#include "bench/harness/specimens/specimen.h"
#include "bench/suites/gpu/gpu_parts.h"
#include "gpu/buffer.h"
#include "gpu/fence.h"
#include "gpu/gl.h"
#include "gpu/limits.h"
#include "gpu/program.h"
#include "solver/gpu/gpu_solver.h"

namespace viscera::bench {

namespace {

using Clock = std::chrono::steady_clock;

constexpr uint32_t kGroupSizes[] = {32, 64, 128, 256, 512, 1024};
constexpr int kLeastSubsteps = 200, kMostSubsteps = 100000;
constexpr double kLongest_s = 30;     // for a group size, on a slow renderer
constexpr double kReadsApart = 1e-5;  // tolerance of sums of 18 float32 numbers below 1, however they are read

double secondsOf(const std::function<void()>& work) {
  gpu::awaitGpu("the start of a measurement");
  const Clock::time_point start = Clock::now();
  work();
  gpu::awaitGpu("a measurement");
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// ---- sizes of work groups ----

void stepTicks(GpuSolver& solver, int ticks) {
  layout::TickStats stats;
  for (int t = 0; t < ticks; ++t) {
    solver.step({});
    while (solver.pollStats(stats, false)) {
    }
  }
}

void measureGroupSizes(Report& report) {
  const Specimen cube = cubeOf(report.isShort() ? 12 : 35);
  const size_t most = gpu::driverLimits().invocations_per_group;
  Table table(
      "work groups: leapfrog on a cube of " + std::to_string(cube.nodes()) + " nodes",
      {{"invocations per group"}, {"substeps"}, {"substep", "us", 3}, {"rate", "M node updates/s", 3}, {"state hash"}});
  int ticks = 0;
  uint64_t first = 0;
  size_t differ = 0, tried = 0;
  for (const uint32_t size : kGroupSizes) {
    if (size > most) {
      report.note("Groups of " + std::to_string(size) + " exceed the limit of this driver.\n");
      continue;
    }
    report.stage("groups of " + std::to_string(size));
    GpuSolver solver(cube.model, cube.scene, {{}, size});
    solver.writeState(cube.start);
    stepTicks(solver, 2);  // drivers compile at the first use
    if (ticks == 0) {      // the same number for all
      const double tick_s = secondsOf([&] { stepTicks(solver, 2); }) / 2;
      const double substeps = report.isShort() ? kLeastSubsteps : kSpecimenSubsteps * kLongest_s / tick_s;
      ticks = static_cast<int>(std::clamp<double>(substeps, kLeastSubsteps, kMostSubsteps)) / kSpecimenSubsteps;
    }
    solver.writeState(cube.start);
    const double seconds = secondsOf([&] { stepTicks(solver, ticks); });
    const uint64_t hash = stateHash(cube.model, solver.readState());
    if (first == 0) first = hash;
    differ += hash != first;
    ++tried;
    const double substep_s = seconds / (ticks * kSpecimenSubsteps);
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    table.add({static_cast<double>(size), static_cast<double>(ticks * kSpecimenSubsteps), 1e6 * substep_s,
               1e-6 * static_cast<double>(cube.nodes()) / substep_s, std::string(text)});
  }
  report.add(table, "groups");
  report.checkAtLeast("group sizes tried", static_cast<double>(tried), 2);
  report.checkAtMost("group sizes whose state differs from that of the first", static_cast<double>(differ), 0);
}

// ---- ways to read ----

struct GpuVariant {
  const char *name, *feature;
  size_t bytes;  ///< bytes per node
};
constexpr GpuVariant kGpuVariants[] = {{"vec4, storage buffer", "STORAGE", 16},
                                       {"vec4, texel fetches", "TEXELS", 16},
                                       {"vec4, image loads", "IMAGES", 16},
                                       {"three floats, storage buffer", "PACKED", 12},
                                       {"three half floats, storage buffer", "HALVES", 8}};

uint16_t halfOf(float value) {  // valid for 0 and normal numbers between 2^-14 and 1
  uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  const int exponent = static_cast<int>(bits >> 23 & 0xff) - 112;
  return exponent <= 0 ? 0
                       : static_cast<uint16_t>(bits >> 16 & 0x8000u) |
                             static_cast<uint16_t>(exponent << 10 | (bits >> 13 & 0x3ff));
}

/// Returns numbers below 1 that are the same for all ways of reading.
std::vector<float> stateFor(const GpuVariant& variant, size_t nodes) {
  std::vector<float> out(variant.bytes / sizeof(float) * nodes, 0.0f);
  for (size_t i = 0; i < nodes; ++i) {
    float v[3];
    for (size_t k = 0; k < 3; ++k) v[k] = static_cast<float>((i * 2654435761u + k * 40503u) % 1024) / 1024;
    if (variant.bytes > 8) {
      std::copy_n(v, 3, &out[variant.bytes / sizeof(float) * i]);
    } else {
      const uint16_t halves[4] = {halfOf(v[0]), halfOf(v[1]), halfOf(v[2]), 0};
      std::memcpy(&out[2 * i], halves, sizeof halves);
    }
  }
  return out;
}

void measureReads(Report& report) {
  const int edge = report.isShort() ? 24 : 160;
  const size_t nodes = static_cast<size_t>(edge) * static_cast<size_t>(edge) * static_cast<size_t>(edge);
  const double copy = gpuCopyRate(report.isShort() ? 32 : 256);
  Table table(
      "reading 18 neighbours and the node itself, cube of " + std::to_string(nodes) + " nodes, no other arithmetic",
      {{"way"},
       {"bytes of a node"},
       {"pass", "ms", 3},
       {"rate", "M nodes/s", 3},
       {"loaded", "GB/s", 3},
       {"moved over copy rate", "", 3}});
  const gpu::Buffer<layout::vec4> sums(nodes, "sums");
  std::vector<layout::vec4> first;
  double apart = 0;
  for (const GpuVariant& variant : kGpuVariants) {
    report.stage(variant.name);
    const gpu::Buffer<float> state(stateFor(variant, nodes), "state");
    const gpu::Program program =
        gpu::Program::compute("gpu_reads.comp", {"GROUP_SIZE " + std::to_string(layout::kGroupSize), variant.feature});
    gpu::TexelView texels;
    if (variant.bytes == 16) texels = gpu::TexelView(state.raw(), gpu::TexelFormat::kRgba32f);
    if (std::string(variant.feature) == "TEXELS") texels.bind(0);
    if (std::string(variant.feature) == "IMAGES")
      glBindImageTexture(0, texels.id(), 0, GL_FALSE, 0, GL_READ_ONLY, GL_RGBA32F);
    program.use();
    program.set("edge", edge);
    state.bindStorage(0);
    sums.bindStorage(1);
    const int passes = report.isShort() ? 2 : 10;
    const auto run = [&] {
      for (int p = 0; p < passes; ++p) {
        gpu::Program::dispatch(nodes, layout::kGroupSize);
        gpu::Program::storageBarrier();
      }
    };
    warmUpGpu(run);
    double seconds = secondsOf(run);
    for (int round = 0; round < 4; ++round) seconds = std::min(seconds, secondsOf(run));
    seconds /= passes;
    const std::vector<layout::vec4> found = sums.read();
    if (first.empty()) first = found;
    for (size_t i = 0; i < nodes; ++i)
      apart =
          std::max(apart, static_cast<double>(std::abs(found[i].x - first[i].x) + std::abs(found[i].z - first[i].z)));
    const double bytes = static_cast<double>(variant.bytes), count = static_cast<double>(nodes);
    table.add({variant.name, bytes, 1e3 * seconds, 1e-6 * count / seconds, 1e-9 * 19 * bytes * count / seconds,
               (bytes + sizeof(layout::vec4)) * count / seconds / copy});
  }
  report.note(
      "Moved is what must come from memory and go there once, a node read and a sum written; loaded is what kernels "
      "ask "
      "the caches for. Copy rate: " +
      Cell(1e-9 * copy).text(3) + " GB/s.\n");
  report.add(table, "reads");
  report.checkAtMost("sums of neighbours read with different methods, difference", apart, kReadsApart);
}

}  // namespace

void gpuSuite(Report& report, gpu::Context& /*context*/) {
  measureParts(report, {{"groups", measureGroupSizes},
                        {"reads", measureReads},
                        {"kernels", measureKernels},
                        {"faces", measureFaces},
                        {"flight", measureFlight},
                        {"live", measureLive},
                        {"bytes", measureBytes}});
}

}  // namespace viscera::bench
