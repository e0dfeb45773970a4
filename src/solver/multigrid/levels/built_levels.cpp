// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/levels/built_levels.h"

#include <tuple>

#include "math/archive.h"

namespace viscera::multigrid {

namespace {

constexpr double kOtherStage = 4;    // times as much inertia: smoothers are told of it
constexpr double kOtherLevels = 16;  // a hierarchy is worth its building

float largestAtRest(FineLevel& level) {
  const Vectors still(3 * level.places());
  level.linearise(still, still);
  return largestOf(level);
}

bool isNear(const Stage& built, const Stage& wanted, double times) {
  return wanted.inertia_per_s2 <= times * built.inertia_per_s2 && built.inertia_per_s2 <= times * wanted.inertia_per_s2;
}

/// Has the level look at a lattice of these nodes.
void show(const std::vector<layout::NodeBits>& nodes, FineLevel& level, CpuLattice& lattice) {
  lattice.store.nodes = nodes;
  lattice.strengths.refreshAll(lattice.store);
  level.refresh();
}

}  // namespace

const BuiltLevels::Built& BuiltLevels::of(FineLevel& level, const Stage& stage) {
  for (const Built& built : built_) {
    if (isNear(built.stage, stage, kOtherStage)) return built;
  }
  level.begin(stage);
  level.hold({});  // who is held today is not tomorrow: only the finest level knows
  Built now{stage, nullptr};
  now.nodes = level.nodes();
  for (const Built& built : built_) {
    if (isNear(built.stage, stage, kOtherLevels))
      std::tie(now.hierarchy, now.nodes) = std::tie(built.hierarchy, built.nodes);
  }
  if (!now.hierarchy) now.hierarchy = std::make_shared<Hierarchy>(level, level.parallel());
  now.largest = largestAtRest(level);
  built_.push_back(std::move(now));
  return built_.back();
}

void BuiltLevels::rebuildAside(FineLevel& level) {
  static const Serial kSerial;
  level.hold({});
  auto copy = std::make_shared<FineLevel>(level, kSerial);
  const Stage stage = built_[0].stage;
  const Parallel& parallel = level.parallel();
  rebuilt_ = std::async(std::launch::async, [copy, stage, &parallel] {
    copy->begin(stage);
    Built out{stage, std::make_shared<Hierarchy>(*copy, parallel)};
    out.largest = largestAtRest(*copy);
    out.nodes = copy->nodes();
    return out;
  });
}

bool BuiltLevels::takeRebuilt() {
  if (!rebuilt_.valid()) return false;
  built_.clear();
  built_.push_back(rebuilt_.get());
  return true;
}

void BuiltLevels::persist(Archive& archive, FineLevel& level, CpuLattice& lattice) {
  std::vector<Built> rebuilt;
  if (!archive.reads() && rebuilt_.valid()) rebuilt.push_back(rebuilt_.get());  // waits
  std::vector<layout::NodeBits> nodes = *level.nodes();
  archive.values(nodes);
  persist(archive, level, lattice, built_);
  persist(archive, level, lattice, rebuilt);
  rebuilt_ = {};
  if (!rebuilt.empty()) {
    std::promise<Built> ready;
    ready.set_value(rebuilt[0]);
    rebuilt_ = ready.get_future();
  }
  if (archive.reads()) show(nodes, level, lattice);
}

void BuiltLevels::persist(Archive& archive, FineLevel& level, CpuLattice& lattice, std::vector<Built>& built) {
  uint64_t count = built.size();
  archive.value(count);
  if (archive.reads()) built.clear();
  for (uint64_t b = 0; b < count; ++b) {
    Built now = archive.reads() ? Built{} : built[b];
    uint64_t from = 0;  // whose hierarchy it has
    while (!archive.reads() && built[from].hierarchy != now.hierarchy) ++from;
    std::vector<layout::NodeBits> nodes = now.nodes ? *now.nodes : *level.nodes();
    archive.value(now.stage);
    archive.value(now.largest);
    archive.value(from);
    archive.values(nodes);
    if (!archive.reads()) continue;
    if (from < b) {
      std::tie(now.hierarchy, now.nodes) = std::tie(built[from].hierarchy, built[from].nodes);
    } else {
      show(nodes, level, lattice);
      level.begin(now.stage);
      now.nodes = level.nodes();
      now.hierarchy = std::make_shared<Hierarchy>(level, level.parallel());
    }
    built.push_back(std::move(now));
  }
}

}  // namespace viscera::multigrid
