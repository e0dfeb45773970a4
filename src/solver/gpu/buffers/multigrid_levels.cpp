// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/buffers/multigrid_levels.h"

#include "layout/bindings.h"
#include "math/float_bits.h"

namespace viscera {

namespace {

constexpr size_t kMostDirect = 512;  // nodes of a coarsest level whose inverse is kept: 12 MB
constexpr int kCoarsestSweeps = 4;   // of the smoother there, if it has more

std::vector<std::string> with(std::vector<std::string> defines, std::initializer_list<const char*> more) {
  defines.insert(defines.end(), more.begin(), more.end());
  return defines;
}

}  // namespace

MultigridCoarseKernels::MultigridCoarseKernels(const FeatureSet& features, bool held)
    : group_size(features.group_size) {
  std::vector<std::string> known = features.defines();
  if (held) known.push_back("HELD");
  const auto compiled = [&](std::initializer_list<const char*> more) {
    return gpu::Program::compute("multigrid_coarse.comp", with(known, more));
  };
  product = compiled({"PRODUCT"});
  solve = compiled({"SOLVE"});
  smooth = compiled({"SMOOTH"});
  restrict_fine = compiled({"RESTRICT", "FINE"});
  restrict_coarse = compiled({"RESTRICT"});
  prolong_fine = compiled({"PROLONG", "FINE"});
  prolong_coarse = compiled({"PROLONG"});
}

MultigridLevels::MultigridLevels(const multigrid::Hierarchy& hierarchy, const std::vector<uint32_t>& slots) {
  const size_t count = hierarchy.levels() - 1;
  uint32_t vectors = 0;
  for (size_t l = 0; l < count; ++l) {
    addLevel(hierarchy.coarse(l));
    Level& level = levels_.back();
    level.right = vectors;
    level.solution = vectors + level.nodes;
    level.change = vectors + 2 * level.nodes;
    vectors += 3 * level.nodes;
    const multigrid::Transfer& t = hierarchy.transfer(l);
    level.down = addWay(t.coarse_starts, t.children, t.coarse_weights, l == 0 ? &slots : nullptr);
    level.up = addWay(t.starts, t.parents, t.weights, nullptr);
  }
  if (count == 0) return;
  if (levels_.back().nodes <= kMostDirect) addCoarsest(hierarchy);
  vectors_ = gpu::Buffer<layout::vec4>(vectors, "vectors of coarse levels");
  matrices_ = gpu::Buffer<layout::vec4>(columns_, "matrices of coarse levels");
  graph_ = gpu::Buffer<uint32_t>(words_, "graphs of coarse levels");
  columns_ = {};
  words_ = {};
}

uint32_t MultigridLevels::addWords(const std::vector<uint32_t>& words) {
  const auto at = static_cast<uint32_t>(words_.size());
  words_.insert(words_.end(), words.begin(), words.end());
  return at;
}

/// @param slots  of the nodes that entries name; null: they stay numbers of nodes
MultigridLevels::Level::Way MultigridLevels::addWay(const std::vector<uint32_t>& starts, std::vector<uint32_t> entries,
                                                    const std::vector<float>& weights,
                                                    const std::vector<uint32_t>* slots) {
  if (slots) {
    for (uint32_t& entry : entries) entry = (*slots)[entry];
  }
  std::vector<uint32_t> bits;
  for (const float weight : weights) bits.push_back(bitsOfFloat(weight));
  return {addWords(starts), addWords(entries), addWords(bits)};
}

void MultigridLevels::addLevel(const multigrid::CoarseLevel& level) {
  Level out{};
  out.nodes = static_cast<uint32_t>(level.nodes());
  out.largest = level.largest;
  out.blocks = static_cast<uint32_t>(columns_.size());
  const auto add = [&](const float* numbers) {
    for (int column = 0; column < 3; ++column, numbers += 4)
      columns_.push_back({numbers[0], numbers[1], numbers[2], 0});
  };
  for (size_t i = 0; i < level.matrix().columns.size(); ++i) add(level.matrix().at(i));
  out.inverse = static_cast<uint32_t>(columns_.size());
  for (size_t node = 0; node < level.nodes(); ++node) add(level.inverseAt(node));
  out.starts = addWords(level.matrix().starts);
  out.columns = addWords(level.matrix().columns);
  levels_.push_back(out);
}

void MultigridLevels::addCoarsest(const multigrid::Hierarchy& hierarchy) {
  const Eigen::MatrixXd inverse = hierarchy.coarsestInverse();
  inverse_ = static_cast<uint32_t>(columns_.size());
  direct_ = true;
  const Eigen::Index nodes = inverse.rows() / 3;
  for (Eigen::Index row = 0; row < nodes; ++row) {
    for (Eigen::Index column = 0; column < 3 * nodes; ++column) {
      const Eigen::Vector3f numbers = inverse.block<3, 1>(3 * row, column).cast<float>();
      columns_.push_back({numbers.x(), numbers.y(), numbers.z(), 0});
    }
  }
}

void MultigridLevels::run(const gpu::Program& program, size_t nodes, uint32_t group_size) const {
  program.set("active_count", static_cast<uint32_t>(nodes));
  gpu::Program::dispatch(nodes, group_size);
  gpu::Program::storageBarrier();
}

void MultigridLevels::tell(const gpu::Program& program, const Level::Way& way) const {
  program.use();
  program.set("starts_first", way.starts);
  program.set("entries_first", way.entries);
  program.set("weights_first", way.weights);
}

void MultigridLevels::smooth(const MultigridCoarseKernels& kernels, const Level& level, float a, float b,
                             bool first) const {
  kernels.smooth.use();
  kernels.smooth.set("x_first", level.right);
  kernels.smooth.set("y_first", level.change);
  kernels.smooth.set("z_first", level.solution);
  kernels.smooth.set("blocks_first", level.inverse);
  kernels.smooth.set("a", a);
  kernels.smooth.set("b", b);
  kernels.smooth.set("first", first ? 1u : 0u);
  run(kernels.smooth, level.nodes, kernels.group_size);
}

/// right -= A change
void MultigridLevels::subtractProduct(const MultigridCoarseKernels& kernels, const Level& level) const {
  kernels.product.use();
  kernels.product.set("x_first", level.change);
  kernels.product.set("y_first", level.right);
  kernels.product.set("blocks_first", level.blocks);
  kernels.product.set("starts_first", level.starts);
  kernels.product.set("entries_first", level.columns);
  kernels.product.set("subtract", 1u);
  run(kernels.product, level.nodes, kernels.group_size);
}

void MultigridLevels::smoothTwice(const MultigridCoarseKernels& kernels, const Level& level, bool first) const {
  const multigrid::Chebyshev cheb(level.largest);
  smooth(kernels, level, 0, cheb.first, first);
  subtractProduct(kernels, level);
  smooth(kernels, level, cheb.again, cheb.second, false);
}

void MultigridLevels::solveCoarsest(const MultigridCoarseKernels& kernels) const {
  const Level& level = levels_.back();
  if (!direct_) {
    for (int sweep = 0; sweep < kCoarsestSweeps; ++sweep) {
      if (sweep > 0) subtractProduct(kernels, level);
      smoothTwice(kernels, level, sweep == 0);
    }
    return;
  }
  kernels.solve.use();
  kernels.solve.set("x_first", level.right);
  kernels.solve.set("y_first", level.solution);
  kernels.solve.set("blocks_first", inverse_);
  run(kernels.solve, level.nodes, kernels.group_size);
}

/// Solution of a level for its right side, which is overwritten (multigrid::Hierarchy).
void MultigridLevels::cycle(const MultigridCoarseKernels& kernels, size_t index) const {
  if (index + 1 == levels_.size()) return solveCoarsest(kernels);
  const Level &level = levels_[index], &below = levels_[index + 1];
  smoothTwice(kernels, level, true);
  subtractProduct(kernels, level);
  tell(kernels.restrict_coarse, below.down);
  kernels.restrict_coarse.set("x_first", level.right);
  kernels.restrict_coarse.set("y_first", below.right);
  run(kernels.restrict_coarse, below.nodes, kernels.group_size);
  cycle(kernels, index + 1);
  tell(kernels.prolong_coarse, below.up);
  kernels.prolong_coarse.set("x_first", below.solution);
  kernels.prolong_coarse.set("y_first", level.change);
  kernels.prolong_coarse.set("z_first", level.solution);
  run(kernels.prolong_coarse, level.nodes, kernels.group_size);
  subtractProduct(kernels, level);
  smoothTwice(kernels, level, false);
}

void MultigridLevels::correct(const MultigridCoarseKernels& kernels, size_t nodes, size_t slots) const {
  vectors_.bindStorage(layout::kBindCoarseVectors);
  matrices_.bindStorage(layout::kBindCoarseMatrices);
  graph_.bindStorage(layout::kBindCoarseGraph);
  const Level& level = levels_[0];
  tell(kernels.restrict_fine, level.down);
  kernels.restrict_fine.set("slot_count", static_cast<uint32_t>(slots));
  kernels.restrict_fine.set("y_first", level.right);
  run(kernels.restrict_fine, level.nodes, kernels.group_size);
  cycle(kernels, 0);
  tell(kernels.prolong_fine, level.up);
  kernels.prolong_fine.set("slot_count", static_cast<uint32_t>(slots));
  kernels.prolong_fine.set("x_first", level.solution);
  run(kernels.prolong_fine, nodes, kernels.group_size);
}

}  // namespace viscera
