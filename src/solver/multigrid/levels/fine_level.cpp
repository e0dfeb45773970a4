// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/levels/fine_level.h"

#include <algorithm>

namespace viscera::multigrid {

namespace {

CellKind kindOf(const CpuStrengths& strengths) {
  if (strengths.bulk.empty()) return CellKind::kNone;
  if (strengths.rigidity.empty()) return CellKind::kVolumes;
  const std::vector<uint32_t>& fills = strengths.moments.of_cell;
  const bool partial = std::any_of(fills.begin(), fills.end(), [](uint32_t fill) { return fill != 0; });
  return partial ? CellKind::kPartialMoments : CellKind::kMoments;
}

}  // namespace

FineLevel::FineLevel(const Model& model, const CpuLattice& lattice, const Parallel& parallel)
    : lattice_(lattice),
      parallel_(&parallel),
      grid_(model),
      kernels_(fineKernelsFor()),
      cells_(kindOf(lattice.strengths)),
      boxes_(grid_.bodies),
      sums_((grid_.blocks.size() + kBlocksPerJob - 1) / kBlocksPerJob) {
  const size_t n = places();
  for (size_t b = 0; b < boxes_.size(); ++b) boxes_[b].params = lattice.store.bodies[b];
  stiffness_.resize(kPairs * n);
  tangent_.resize(kPairs * kTangentNumbers * n);
  inverse_.resize(6 * n);
  force_.resize(3 * n);
  for (AlignedVector<float>* each : {&mass_, &free_, &movable_, &diagonal_}) each->resize(n);
  if (cells_ != CellKind::kNone) {
    edges_.resize(9 * n);
    resists_.resize(3 * n);
    corners_.resize(kCornerNumbers * n);
    bulk_.resize(n);
    if (cells_ != CellKind::kVolumes) rigidity_.resize(n);
    if (cells_ == CellKind::kPartialMoments) moments_.resize(9 * n);
    loadCells();
    if (!lattice.strengths.moments.bend_of_cell.empty()) loadBends();
  }
  for (uint32_t node = 0; node < grid_.nodeCount(); ++node)
    mass_[grid_.place_of[node]] = lattice.strengths.mass[grid_.slots[node]];
  refresh();
}

/// Which places have cells, and the moments of these, which never change.
void FineLevel::loadCells() {
  constexpr float kTwelfth = 1.0f / 12;
  for (uint32_t node = 0; node < grid_.nodeCount(); ++node) {
    const uint32_t slot = grid_.slots[node];
    if (!(lattice_.store.whole_nodes[slot].lo & layout::kCellBit)) continue;
    cell_nodes_.push_back(node);
    const uint32_t place = grid_.place_of[node];
    const Block block = {place / static_cast<uint32_t>(kBlock) * static_cast<uint32_t>(kBlock), grid_.bodyOf(node)};
    if (cell_blocks_.empty() || cell_blocks_.back().at != block.at) cell_blocks_.push_back(block);
    if (moments_.empty()) continue;
    const JoinedMoments& joined = lattice_.strengths.moments;
    const layout::vec4* m = &joined.vectors[kVectorsPerFill * joined.of_cell[slot]];
    const float twice_h = 2 * lattice_.store.bodyOf(slot).origin_spacing.w;
    const float numbers[9] = {twice_h * m[0].x, twice_h * m[0].y, twice_h * m[0].z, m[1].x, m[1].y,
                              m[1].z,           m[2].x,           m[2].y,           m[2].z};
    for (size_t i = 0; i < 9; ++i) moments_[i * places() + place] = numbers[i];
    if (joined.of_cell[slot] == 0)
      for (size_t i = 3; i < 6; ++i) moments_[i * places() + place] = kTwelfth;
  }
  // Slots are in the order of bricks, places in that of rows.
  std::sort(cell_blocks_.begin(), cell_blocks_.end(), [](const Block& a, const Block& b) { return a.at < b.at; });
  cell_blocks_.erase(std::unique(cell_blocks_.begin(), cell_blocks_.end(),
                                 [](const Block& a, const Block& b) { return a.at == b.at; }),
                     cell_blocks_.end());
}

/// What thin walls add to cells, which never changes.
void FineLevel::loadBends() {
  constexpr size_t kNumbers = layout::kBendNumbers * kBlock;
  const JoinedMoments& joined = lattice_.strengths.moments;
  bend_block_.assign(places() / kBlock, 0);
  uint32_t blocks = 0;
  for (const uint32_t node : cell_nodes_) {
    uint32_t& block = bend_block_[grid_.place_of[node] / kBlock];
    if (block == 0 && joined.bendOf(grid_.slots[node]) != nullptr) block = ++blocks;
  }
  bends_.resize(blocks * kNumbers);
  for (const uint32_t node : cell_nodes_) {
    const uint32_t slot = grid_.slots[node], place = grid_.place_of[node];
    const float* numbers = joined.bendOf(slot);
    if (numbers == nullptr) continue;
    const float twice_h = 2 * lattice_.store.bodyOf(slot).origin_spacing.w;
    float* to = &bends_[(bend_block_[place / kBlock] - 1) * kNumbers + place % kBlock];
    for (size_t n = 0; n < layout::kBendNumbers; ++n)
      to[n * kBlock] = n < layout::kBendPairs ? numbers[n] : twice_h * numbers[n];
  }
}

const float* FineLevel::bendAt(size_t place) const {
  const uint32_t block = bend_block_.empty() ? 0 : bend_block_[place / kBlock];
  if (block == 0) return nullptr;
  const float* numbers = &bends_[(block - 1) * layout::kBendNumbers * kBlock + place % kBlock];
  for (size_t n = 0; n < layout::kBendNumbers; ++n) {
    if (numbers[n * kBlock] != 0) return numbers;
  }
  return nullptr;
}

void FineLevel::refresh() {
  nodes_ = std::make_shared<const std::vector<layout::NodeBits>>(lattice_.store.nodes);
  for (uint32_t node = 0; node < grid_.nodeCount(); ++node) {
    const uint32_t slot = grid_.slots[node], place = grid_.place_of[node];
    for (uint32_t pair = 0; pair < kPairs; ++pair)
      stiffness_[pair * places() + place] = lattice_.strengths.stiffness[stiffnessAt(slot, pair)];
    movable_[place] = lattice_.strengths.mobility[slot] > 0 ? 1.0f : 0.0f;
  }
  free_ = movable_;
  hold({});
  for (const uint32_t node : cell_nodes_) {
    bulk_[grid_.place_of[node]] = lattice_.strengths.bulk[grid_.slots[node]];
    if (!rigidity_.empty()) rigidity_[grid_.place_of[node]] = lattice_.strengths.rigidity[grid_.slots[node]];
  }
}

double FineLevel::stiffest() const {
  double out = 0;
  for (const uint32_t place : grid_.place_of) {
    double k = 0;
    for (size_t pair = 0; pair < kPairs; ++pair) k += 2 * static_cast<double>(stiffness(pair, place));
    out = std::max(out, k);
  }
  return out;
}

void FineLevel::hold(const std::vector<uint32_t>& held, const std::vector<Plane>& planes) {
  for (const uint32_t place : held_) free_[place] = movable_[place];
  held_ = held;
  for (const uint32_t place : held_) free_[place] = 0;
  planes_ = planes;
}

void FineLevel::project(Vectors& x) const {
  for (const Plane& plane : planes_) projectAt(plane, x.data());
}

void FineLevel::projectAt(const Plane& plane, float* x) const {
  const size_t n = places();
  float* const at = x + plane.place;
  const float along = plane.normal.x() * at[0] + plane.normal.y() * at[n] + plane.normal.z() * at[2 * n];
  for (size_t c = 0; c < 3; ++c) at[c * n] -= along * plane.normal[static_cast<int>(c)];
}

void FineLevel::begin(const Stage& stage) {
  for (Box& box : boxes_) box.damping_rate_per_s = static_cast<float>(stage.rate_per_s);
  for (const Block& block : grid_.blocks) {
    const double inertia =
        stage.inertia_per_s2 + static_cast<double>(boxes_[block.body].params.drag_per_s) * stage.rate_per_s;
    for (size_t i = block.at; i < block.at + kBlock; ++i)
      diagonal_[i] = static_cast<float>(inertia * static_cast<double>(mass_[i]));
  }
}

FineArrays FineLevel::arrays() const {
  FineArrays a{};
  a.places = places();
  a.boxes = boxes_.data();
  a.displacement = displacement_;
  a.velocity = velocity_;
  a.stiffness = stiffness_.data();
  a.diagonal = diagonal_.data();
  a.free = free_.data();
  a.bulk = bulk_.data();
  a.rigidity = rigidity_.data();
  a.moments = moments_.data();
  a.bend_block = bend_block_.empty() ? nullptr : bend_block_.data();
  a.bends = bends_.data();
  a.tangent = tangent_.data();
  a.edges = edges_.data();
  a.resists = resists_.data();
  a.corners = corners_.data();
  a.force = force_.data();
  a.inverse = inverse_.data();
  a.cells = cells_;
  return a;
}

/// Calls kernel(first block, count, job).
template <class Kernel>
void FineLevel::runBlocks(const std::vector<Block>& blocks, const Kernel& kernel) const {
  parallel()((blocks.size() + kBlocksPerJob - 1) / kBlocksPerJob, [&](size_t job) {
    const size_t first = job * kBlocksPerJob;
    kernel(&blocks[first], std::min(kBlocksPerJob, blocks.size() - first), job);
  });
}

double FineLevel::run(EvaluateCells cells, EvaluateNodes nodes, const std::vector<Block>& blocks,
                      const std::vector<Block>& cell_blocks, const Vectors& u, const Vectors& v) {
  displacement_ = u.data();
  velocity_ = v.data();
  FineArrays a = arrays();
  a.free = movable_.data();  // who is held now may be free in the next system
  std::fill(sums_.begin(), sums_.end(), 0.0);
  runBlocks(cell_blocks, [&](const Block* some, size_t count, size_t job) { cells(a, some, count, &sums_[job]); });
  runBlocks(blocks, [&](const Block* some, size_t count, size_t job) { nodes(a, some, count, &sums_[job]); });
  done_.forces += static_cast<double>(blocks.size()) / static_cast<double>(std::max(grid_.blocks.size(), size_t{1}));
  double energy_j = 0;
  for (const double each : sums_) energy_j += each;
  return energy_j;
}

double FineLevel::linearise(const Vectors& displacement_m, const Vectors& velocity_m_per_s) {
  return run(kernels_.linearise_cells, kernels_.linearise_nodes, grid_.blocks, cell_blocks_, displacement_m,
             velocity_m_per_s);
}

double FineLevel::evaluate(const Vectors& displacement_m, const Vectors& velocity_m_per_s) {
  return run(kernels_.evaluate_cells, kernels_.evaluate_nodes, grid_.blocks, cell_blocks_, displacement_m,
             velocity_m_per_s);
}

void FineLevel::lineariseIn(const Region& region, const Vectors& displacement_m, const Vectors& velocity_m_per_s) {
  run(kernels_.linearise_cells, kernels_.linearise_nodes, region.blocks, region.cell_blocks, displacement_m,
      velocity_m_per_s);
}

Region FineLevel::around(const std::vector<uint32_t>& nodes) const {
  const auto before = [](const Block& a, const Block& b) { return a.at < b.at; };
  const auto blockAt = [](size_t place) { return static_cast<uint32_t>(place / kBlock * kBlock); };
  Region out;
  for (const uint32_t node : nodes) {
    const uint32_t body = grid_.bodyOf(node);
    const size_t place = grid_.place_of[node];
    out.blocks.push_back({blockAt(place), body});
    for (int c = 0; c < 8; ++c) {
      const Block block = {blockAt(grid_.beside(body, place, -(c & 1), -(c >> 1 & 1), -(c >> 2))), body};
      if (std::binary_search(cell_blocks_.begin(), cell_blocks_.end(), block, before)) out.cell_blocks.push_back(block);
    }
  }
  for (std::vector<Block>* each : {&out.blocks, &out.cell_blocks}) {
    std::sort(each->begin(), each->end(), before);
    each->erase(std::unique(each->begin(), each->end(), [](const Block& a, const Block& b) { return a.at == b.at; }),
                each->end());
  }
  return out;
}

Vector3f FineLevel::solveBlock(size_t place, const Vector3f& r) const {
  const size_t n = places();
  const float *i = &inverse_[place], xy = i[n], xz = i[2 * n], yz = i[4 * n];
  return {i[0] * r.x() + xy * r.y() + xz * r.z(), xy * r.x() + i[3 * n] * r.y() + yz * r.z(),
          xz * r.x() + yz * r.y() + i[5 * n] * r.z()};
}

void FineLevel::apply(const Vectors& x, Vectors& y, bool subtract) const {
  const FineArrays a = arrays();
  runBlocks(cell_blocks_,
            [&](const Block* blocks, size_t count, size_t) { kernels_.apply_cells(a, x.data(), blocks, count); });
  runBlocks(grid_.blocks, [&](const Block* blocks, size_t count, size_t) {
    kernels_.apply_nodes(a, x.data(), y.data(), subtract, blocks, count);
  });
  project(y);
  ++done_.products;
}

/// Sum of what kernel(first block, count, sum) adds.
template <class Kernel>
double FineLevel::sumBlocks(const Kernel& kernel) const {
  std::fill(sums_.begin(), sums_.end(), 0.0);
  runBlocks(grid_.blocks, [&](const Block* blocks, size_t count, size_t job) { kernel(blocks, count, &sums_[job]); });
  double out = 0;
  for (const double each : sums_) out += each;
  return out;
}

void FineLevel::precondition(const Vectors& r, float by, Vectors& copy, Vectors& d) const {
  const FineArrays a = arrays();
  runBlocks(grid_.blocks, [&](const Block* blocks, size_t count, size_t) {
    kernels_.precondition_nodes(a, r.data(), by, copy.data(), d.data(), blocks, count);
  });
  project(d);
}

double FineLevel::smooth(const Vectors& x, float again, float by, float carried, Vectors& r, Vectors& d, Vectors& z,
                         const Vectors* with) const {
  return smooth({x.data(), r.data(), d.data(), z.data(), with ? with->data() : nullptr, again, by, carried, false});
}

void FineLevel::smoothFresh(const Vectors& x, float again, float by, Vectors& r, Vectors& d, Vectors& z) const {
  smooth({x.data(), r.data(), d.data(), z.data(), nullptr, again, by, 1, true});
}

double FineLevel::smooth(const Smoothing& smoothing) const {
  const FineArrays a = arrays();
  runBlocks(cell_blocks_,
            [&](const Block* blocks, size_t count, size_t) { kernels_.apply_cells(a, smoothing.x, blocks, count); });
  const double out = sumBlocks(
      [&](const Block* blocks, size_t count, double* sum) { kernels_.smooth_nodes(a, smoothing, blocks, count, sum); });
  ++done_.products;
  return out + smoothHeld(smoothing);
}

/// A smoothing of nodes that keep to planes once more, within these. @return what that adds to with . z
double FineLevel::smoothHeld(const Smoothing& s) const {
  const size_t n = places();
  const auto at = [&](const float* x, size_t i) { return Vector3f(x[i], x[n + i], x[2 * n + i]); };
  double out = 0;
  for (size_t first = 0, end = 0; first < planes_.size(); first = end) {  // planes of a node stand together
    const size_t i = planes_[first].place;
    while (end < planes_.size() && planes_[end].place == i) ++end;
    const Vector3f before = at(s.z, i), begun = before - at(s.d, i);
    const auto set = [&](float* x, const Vector3f& value) {
      for (size_t c = 0; c < 3; ++c) x[c * n + i] = value[static_cast<int>(c)];
      for (size_t k = first; k < end; ++k) projectAt(planes_[k], x);
    };
    set(s.r, at(s.r, i));
    set(s.d, s.again * at(s.x, i) + s.by * solveBlock(i, at(s.r, i)));
    set(s.z, begun + at(s.d, i));
    if (s.with) out += static_cast<double>(at(s.with, i).dot(at(s.z, i) - before));
  }
  return out;
}

double FineLevel::advance(float alpha, const Vectors& p, const Vectors& q, Vectors& s, Vectors& r) const {
  return sumBlocks([&](const Block* blocks, size_t count, double* sum) {
    kernels_.advance_nodes(places(), alpha, p.data(), q.data(), s.data(), r.data(), blocks, count, sum);
  });
}

void FineLevel::turn(float beta, const Vectors& z, Vectors& p) const {
  runBlocks(grid_.blocks, [&](const Block* blocks, size_t count, size_t) {
    kernels_.turn_nodes(places(), beta, z.data(), p.data(), blocks, count);
  });
}

double FineLevel::dot(const Vectors& a, const Vectors& b) const {
  return sumBlocks([&](const Block* blocks, size_t count, double* sum) {
    kernels_.dot_nodes(places(), a.data(), b.data(), blocks, count, sum);
  });
}

}  // namespace viscera::multigrid
