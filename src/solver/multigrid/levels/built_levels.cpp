// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/levels/built_levels.h"

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

}  // namespace

const BuiltLevels::Built& BuiltLevels::of(FineLevel& level, const Stage& stage) {
  for (const Built& built : built_) {
    if (isNear(built.stage, stage, kOtherStage)) return built;
  }
  level.begin(stage);
  level.hold({});  // who is held today is not tomorrow: only the finest level knows
  Built now{stage, nullptr};
  for (const Built& built : built_) {
    if (isNear(built.stage, stage, kOtherLevels)) now.hierarchy = built.hierarchy;
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
    return out;
  });
}

bool BuiltLevels::takeRebuilt() {
  if (!rebuilt_.valid()) return false;
  built_.clear();
  built_.push_back(rebuilt_.get());
  return true;
}

}  // namespace viscera::multigrid
