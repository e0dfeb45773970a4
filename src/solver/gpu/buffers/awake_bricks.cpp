// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/buffers/awake_bricks.h"

#include <algorithm>
#include <cstring>

#include "gpu/archive.h"
#include "gpu/limits.h"
#include "layout/bindings.h"
#include "layout/surface_offsets.h"
#include "solver/cpu/state/sleep.h"
#include "solver/tissue/joined_lattice.h"

namespace viscera {

namespace {

/// Returns the number of storage blocks of LIST, the kernel with most of them.
size_t mostBlocks(const FeatureSet& features) {
  return features.law ? 10 : 8;
}

/// Returns the number of invocations per brick. On a GPU they run in parallel. On a software renderer they would run
/// one after the other and wait for each other, so there is one.
uint32_t lanes() {
  return gpu::driverLimits().loads ? layout::kBrickSlots : 1;
}

gpu::Program compiled(const FeatureSet& of, const char* feature, bool tools = false) {
  FeatureSet features = of;
  if (lanes() > 1) features.group_size = lanes();
  std::vector<std::string> defines = features.defines();
  defines.push_back("LANES " + std::to_string(lanes()));
  defines.push_back(feature);
  if (tools) defines.push_back("TOOLS");
  return gpu::Program::compute("awake_bricks.comp", defines);
}

/// Finds the range of each brick in an ascending list of slots.
void countIn(const std::vector<uint32_t>& slots, std::vector<layout::SleepingBrick>& bricks,
             uint32_t layout::SleepingBrick::*first, uint32_t layout::SleepingBrick::*count) {
  for (uint32_t i = 0; i < slots.size(); ++i) {
    layout::SleepingBrick& brick = bricks[slots[i] / layout::kBrickSlots];
    if (brick.*count == 0) brick.*first = i;
    ++(brick.*count);
  }
}

std::vector<layout::SleepingBrick> bricksOf(const Model& model, const FeatureSet& features, size_t count) {
  std::vector<layout::SleepingBrick> out(count);
  countIn(movingSlots(model), out, &layout::SleepingBrick::first_node, &layout::SleepingBrick::node_count);
  if (features.law)
    countIn(cellSlots(model), out, &layout::SleepingBrick::first_cell, &layout::SleepingBrick::cell_count);
  return out;
}

size_t listBytes(size_t items) {
  return sizeof(layout::AwakeList) + items * sizeof(uint32_t);
}

float deepest(const Model& model) {
  const std::vector<float> depths_m = surfaceDepths(model);
  return depths_m.empty() ? 0 : std::max(0.0f, *std::max_element(depths_m.begin(), depths_m.end()));
}

}  // namespace

bool AwakeBricks::fits(const FeatureSet& features) {
  return gpu::driverLimits().storage_blocks >= mostBlocks(features);
}

AwakeBricks::AwakeBricks(const Model& model, const FeatureSet& features, const LatticeBuffers& buffers,
                         double speed_m_per_s)
    : all_program_(compiled(features, "WAKE_ALL")),
      check_program_(compiled(features, "CHECK")),
      list_(compiled(features, "LIST")),
      bricks_(bricksOf(model, features, buffers.store.bricks.size()), "sleeping bricks"),
      nodes_(listBytes(buffers.store.active_count), "awake nodes"),
      slow2_(static_cast<float>(speed_m_per_s * speed_m_per_s)),
      deepest_m_(deepest(model) + edgeReach(model)),
      beside_(features.law ? layout::kFarthestTissue : 0),
      group_size_(features.group_size),
      substeps_between_checks_(features.walls ? Sleep::kSubstepsWithWalls : Sleep::kSubsteps) {
  if (features.law) cells_ = gpu::RawBuffer(listBytes(buffers.store.cells.size()), "awake cells");
  if (!features.tools) return;
  check_with_tools_ = compiled(features, "CHECK", true);
  near_ = compiled(features, "WAKE_NEAR");
  held_ = compiled(features, "WAKE_HELD");
  cut_ = compiled(features, "WAKE_CUT");
  marked_ = compiled(features, "WAKE_MARKED");
}

void AwakeBricks::bind() const {
  bricks_.bindStorage(layout::kBindSleepingBricks);
  nodes_.bindStorage(layout::kBindAwakeNodes);
  if (cells_.bytes()) cells_.bindStorage(layout::kBindAwakeCells);
}

void AwakeBricks::run(const gpu::Program& program) {
  program.use();
  program.set("brick_count", static_cast<uint32_t>(bricks_.size()));
  gpu::Program::dispatch(lanes() * bricks_.size(), lanes() > 1 ? lanes() : group_size_);
  gpu::Program::storageBarrier();
  listed_ = false;
}

void AwakeBricks::wakeNear(const std::vector<ToolBox>& boxes) {
  if (boxes.empty() || all_) return;
  float low[layout::kMostToolBoxes][3] = {}, high[layout::kMostToolBoxes][3] = {};
  for (size_t i = 0; i < boxes.size(); ++i) {
    std::copy_n(boxes[i].low.data(), 3, low[i]);
    std::copy_n(boxes[i].high.data(), 3, high[i]);
  }
  near_.setVectors("box_low", low[0], 3, boxes.size());
  near_.setVectors("box_high", high[0], 3, boxes.size());
  near_.set("box_count", static_cast<uint32_t>(boxes.size()));
  run(near_);
}

void AwakeBricks::wakeHeld() {
  if (!all_) run(held_);
}

void AwakeBricks::wakeCut(uint32_t stylus) {
  if (all_) return;
  cut_.set("stylus", stylus);
  cut_.set("beside", beside_);
  run(cut_);
}

void AwakeBricks::wakeMarked() {
  if (!all_) run(marked_);
}

void AwakeBricks::list() {
  if (all_) run(all_program_);
  all_ = false;
  if (listed_) return;
  list_.set("check", 0u);
  list_.set("group_size", group_size_);
  run(list_);
  listed_ = true;
}

void AwakeBricks::dispatchNodes() const {
  gpu::Program::dispatchIndirect(nodes_);
}

void AwakeBricks::dispatchCells() const {
  gpu::Program::dispatchIndirect(cells_);
}

bool AwakeBricks::isCheck(const Substep& step) {
  since_check_s_ += static_cast<double>(step.dt_s);
  return ++substeps_since_check_ >= substeps_between_checks_;
}

void AwakeBricks::passed(const Substep& step) {
  if (!isCheck(step)) return;
  check_ = std::max(1u, check_ + 1);
  const gpu::Program& program = step.tools ? check_with_tools_ : check_program_;
  program.set("check", check_);
  program.set("since_s", static_cast<float>(since_check_s_));
  program.set("slow2", slow2_);
  program.set("sleeps_after_s", static_cast<float>(Sleep::kQuiet_s));
  if (step.tools) program.set("deepest_m", deepest_m_);
  run(program);
  list_.set("check", check_);
  list_.set("sleeps_after_s", static_cast<float>(Sleep::kQuiet_s));
  list_.set("group_size", group_size_);
  run(list_);
  listed_ = true;
  restart();
}

void AwakeBricks::slept(const Substep& step) {
  if (isCheck(step)) restart();
}

/// Checks the ranges of bricks in a saved state.
/// @param here  those of this scene
/// @throws Error  they differ
void AwakeBricks::requireBricks(const Archive& archive, const std::vector<layout::SleepingBrick>& here) const {
  const std::vector<layout::SleepingBrick> read = bricks_.read();
  for (size_t b = 0; b < here.size(); ++b) {
    const layout::SleepingBrick &is = read[b], &was = here[b];
    const bool same = is.kind <= layout::kNeverSleeps && is.first_node == was.first_node &&
                      is.node_count == was.node_count && is.first_cell == was.first_cell &&
                      is.cell_count == was.cell_count;
    if (!same) archive.require(false, "brick " + std::to_string(b) + " does not belong to this tissue");
    if (is.awake > 1) archive.require(false, "brick " + std::to_string(b) + " is neither awake nor asleep");
  }
}

/// Saves or loads a list.
/// @param slots  the list may hold slots below this number
/// @throws Error
void AwakeBricks::persistList(Archive& archive, gpu::RawBuffer& list, size_t slots) {
  gpu::persist(archive, list);
  if (!archive.reads() || list.bytes() == 0) return;
  std::vector<uint32_t> words(list.bytes() / sizeof(uint32_t));
  list.read(0, list.bytes(), words.data());
  layout::AwakeList head;
  std::memcpy(&head, words.data(), sizeof head);
  constexpr size_t kHead = sizeof head / sizeof(uint32_t);
  archive.require(head.count <= words.size() - kHead, "the list of awake items is longer than possible");
  const uint32_t groups = (head.count + group_size_ - 1) / group_size_;
  archive.require(head.groups_x <= std::max(1U, groups) && head.groups_y <= std::max(1U, groups) && head.groups_z <= 1,
                  "more groups are dispatched than items are awake");
  archive.require(std::all_of(words.begin() + kHead, words.begin() + kHead + head.count,
                              [slots](uint32_t slot) { return slot < slots; }),
                  "an item of the list of awake items does not exist");
}

void AwakeBricks::persist(Archive& archive) {
  const std::vector<layout::SleepingBrick> here = bricks_.read();
  gpu::persist(archive, bricks_);
  if (archive.reads()) requireBricks(archive, here);
  const size_t slots = bricks_.size() * layout::kBrickSlots;
  persistList(archive, nodes_, slots);
  persistList(archive, cells_, slots);
  archive.value(all_);
  archive.value(listed_);
  archive.value(since_check_s_);
  archive.value(substeps_since_check_);
  archive.value(check_);
}

void AwakeBricks::restart() {
  since_check_s_ = 0;
  substeps_since_check_ = 0;
}

std::vector<uint8_t> AwakeBricks::awake() const {
  std::vector<uint8_t> out;
  for (const layout::SleepingBrick& brick : bricks_.read()) out.push_back(brick.awake != 0);
  return out;
}

}  // namespace viscera
