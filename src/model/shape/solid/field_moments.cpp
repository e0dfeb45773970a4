// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Moments of the part of each cell where a field is negative. The field is sampled at the corners of 4^3 small cubes
// per cell and taken as linear in six tetrahedra of each, so that a flat face is exact. A curved face would be replaced
// by its chords. Half of the difference between a cube's mean and that of its corners, about d^2/12 of the field's
// Laplacian, is subtracted from all corners, unless the field has a crease there.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <future>
#include <limits>
#include <map>

#include "math/processors.h"
#include "model/shape/solid/cell_fill.h"
#include "model/shape/solid/node_depths.h"
#include "model/shape/solid/solid_grid.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

constexpr int kCuts = 4;  ///< small cubes along an edge of a cell
constexpr int kOctant = kCuts / 2;
constexpr int kBlockCells = 8;  ///< cells along an edge of a block with samples in memory
constexpr int kBlockSamples = kBlockCells * kCuts + 1;
/// Depth of samples, in cells, from which a cell has no surface. No point of a cell is more than 0.56 from its corners
/// and centre, so a field may be up to 1.8 times as steep as a distance.
constexpr double kClear = 1;
/// The same for an octant, with all points within 0.43 of its corners: for 1.4 times as steep.
constexpr double kClearOctant = 0.6;
/// Second difference of samples, over their distance, that counts as a crease; a ball of two cells has 0.125.
constexpr double kCrease = 0.5;

/// Samples of a field at the corners of small cubes, taken on first use.
class BlockSamples {
 public:
  explicit BlockSamples(const DistanceField& field) : field_(field) {}

  void moveTo(const Vector3d& corner_m, double step_m) {
    corner_m_ = corner_m;
    step_m_ = step_m;
    samples_.assign(kBlockSamples * kBlockSamples * kBlockSamples, {kUnknown, 0});
  }
  const LabelledDistance& at(const Vector3i& i) {
    LabelledDistance& sample = samples_[i.x() + kBlockSamples * (i.y() + kBlockSamples * i.z())];
    if (std::isnan(sample.distance_m)) sample = field_(corner_m_ + step_m_ * i.cast<double>());
    return sample;
  }

 private:
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const DistanceField& field_;
  Vector3d corner_m_ = Vector3d::Zero();
  double step_m_ = 0;
  std::vector<LabelledDistance> samples_;
};

Vector3i cornerOf(int c) {
  return {c & 1, (c >> 1) & 1, (c >> 2) & 1};
}

/// Corners of the six tetrahedra around a cube's diagonal.
constexpr std::array<std::array<int, 4>, 6> kTetrahedra = {
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

/// Adds the part of a tetrahedron where a linear field is negative.
void addTetrahedron(const std::array<Vector3d, 4>& corners, const std::array<double, 4>& values, CellFill& sum) {
  std::array<int, 4> in{}, out{};
  int ins = 0, outs = 0;
  for (int i = 0; i < 4; ++i) (values[i] < 0 ? in[ins++] : out[outs++]) = i;
  const auto between = [&](int a, int b) -> Vector3d {
    return corners[a] + values[a] / (values[a] - values[b]) * (corners[b] - corners[a]);
  };
  if (ins == 0) return;
  if (ins == 1) {
    const int a = in[0];
    return add(sum, tetFill({corners[a], between(a, out[0]), between(a, out[1]), between(a, out[2])}));
  }
  if (ins == 2) {
    const int a = in[0], b = in[1], c = out[0], d = out[1];
    const Vector3d ac = between(a, c), ad = between(a, d), bc = between(b, c), bd = between(b, d);
    add(sum, tetFill({corners[a], ac, ad, bd}));
    add(sum, tetFill({corners[a], ac, bc, bd}));
    return add(sum, tetFill({corners[a], corners[b], bc, bd}));
  }
  add(sum, tetFill(corners));
  if (ins == 4) return;
  const int a = out[0];
  add(sum, tetFill({corners[a], between(a, in[0]), between(a, in[1]), between(a, in[2])}), -1);
}

/// Adds the part of a small cube where its field, given at its corners, is negative.
void addCube(const Vector3d& low, const std::array<double, 8>& values, CellFill& sum) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  if (*least >= 0) return;
  const double edge = 1.0 / kCuts;
  if (*most < 0) return add(sum, boxFill(low, low + Vector3d::Constant(edge)));
  for (const auto& t : kTetrahedra) {
    std::array<Vector3d, 4> corners;
    std::array<double, 4> there{};
    for (int i = 0; i < 4; ++i) {
      corners[i] = low + edge * cornerOf(t[i]).cast<double>();
      there[i] = values[t[i]];
    }
    addTetrahedron(corners, there, sum);
  }
}

/// One cell of a block.
class FieldCell {
 public:
  /// @param first  index of the sample at its lowest corner
  FieldCell(BlockSamples& samples, const Vector3i& first, double spacing_m)
      : samples_(samples), first_(first), spacing_m_(spacing_m) {}

  const LabelledDistance& middle() const { return at(Vector3i::Constant(kCuts / 2)); }

  /// Returns whether no surface passes through the cell, judged by its corners and its centre.
  bool isUniform() const {
    const bool inside = middle().distance_m < 0;
    if (std::abs(middle().distance_m) < kClear * spacing_m_) return false;
    for (int c = 0; c < 8; ++c) {
      const double value = at(kCuts * cornerOf(c)).distance_m;
      if ((value < 0) != inside || std::abs(value) < kClear * spacing_m_) return false;
    }
    return true;
  }

  CellFill fill() const {
    CellFill sum = noFill();
    for (int c = 0; c < 8; ++c) addOctant(kOctant * cornerOf(c), sum);
    return sum;
  }

  /// Returns the label of the part that contains most samples with tissue.
  uint16_t commonLabel() const {
    for (const int step : {kOctant, 1}) {  // the coarse samples exist already
      std::map<uint16_t, int> counts;
      const int per_axis = kCuts / step + 1;
      for (int i = 0; i < per_axis * per_axis * per_axis; ++i) {
        const LabelledDistance& s = at(step * Vector3i(i % per_axis, i / per_axis % per_axis, i / per_axis / per_axis));
        if (s.distance_m < 0) ++counts[s.part];
      }
      const auto common = std::max_element(counts.begin(), counts.end(),
                                           [](const auto& a, const auto& b) { return a.second < b.second; });
      if (common != counts.end()) return common->first + 1;
    }
    return 1;
  }

 private:
  const LabelledDistance& at(const Vector3i& i) const { return samples_.at(first_ + i); }

  /// @param first  index of the small cube at the octant's lowest corner
  void addOctant(const Vector3i& first, CellFill& sum) const {
    const Vector3d low = first.cast<double>() / kCuts - Vector3d::Constant(0.5);
    const bool inside = at(first).distance_m < 0;
    bool uniform = true;
    for (int c = 0; c < 8 && uniform; ++c) {
      const double value = at(first + kOctant * cornerOf(c)).distance_m;
      uniform = (value < 0) == inside && std::abs(value) > kClearOctant * spacing_m_;
    }
    if (uniform) {
      if (inside) add(sum, boxFill(low, low + Vector3d::Constant(0.5)));
      return;
    }
    const double shift = chordShift(first);
    for (int cube = 0; cube < 8; ++cube) {
      std::array<double, 8> values{};
      for (int c = 0; c < 8; ++c) values[c] = at(first + cornerOf(cube) + cornerOf(c)).distance_m + shift;
      addCube(low + cornerOf(cube).cast<double>() / kCuts, values, sum);
    }
  }

  /// Returns the correction that turns the mean over chords into that of the field, in an octant.
  double chordShift(const Vector3i& first) const {
    const double step_m = spacing_m_ / kCuts;
    double sum = 0;  // sum of second differences, over nine lines along each axis
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3i along = Vector3i::Unit(axis), u = Vector3i::Unit((axis + 1) % 3),
                     v = Vector3i::Unit((axis + 2) % 3);
      for (int i = 0; i < 9; ++i) {
        const Vector3i here = first + along + i % 3 * u + i / 3 * v;
        const double second = at(here - along).distance_m - 2 * at(here).distance_m + at(here + along).distance_m;
        if (std::abs(second) > kCrease * step_m) return 0;
        sum += second;
      }
    }
    return -sum / 9 / 12;  // second differences are d^2 times the derivative
  }

  BlockSamples& samples_;
  Vector3i first_;
  double spacing_m_;
};

/// Results of filling a block, in addition to labels.
struct Found {
  std::vector<PartialCell> partial, slivers;
};

void fillCell(const FieldCell& cell, size_t index, Solid& solid, Found& found) {
  const LabelledDistance& middle = cell.middle();
  if (cell.isUniform()) {
    if (middle.distance_m < 0) solid.labels[index] = middle.part + 1;
    return;
  }
  const CellFill fill = cell.fill();
  if (fill.share < kLeastShare) return found.slivers.push_back({index, fill});
  solid.labels[index] = middle.distance_m < 0 ? middle.part + 1 : cell.commonLabel();
  if (fill.share <= 1 - kLeastGap) found.partial.push_back({index, fill});
}

void fillBlock(const Vector3i& first, BlockSamples& samples, Solid& solid, Found& found) {
  samples.moveTo(solid.origin_m + solid.spacing_m * first.cast<double>(), solid.spacing_m / kCuts);
  const Vector3i end = (first.array() + kBlockCells).min(solid.cells.array());
  for (int z = first.z(); z < end.z(); ++z) {
    for (int y = first.y(); y < end.y(); ++y) {
      for (int x = first.x(); x < end.x(); ++x) {
        const FieldCell cell(samples, kCuts * (Vector3i(x, y, z) - first), solid.spacing_m);
        fillCell(cell, solid.index(x, y, z), solid, found);
      }
    }
  }
}

/// Fills a layer of blocks on several threads: fields are the slowest part of a phantom.
void fillLayer(const DistanceField& field, int z, Solid& solid, Found& found) {
  const Vector3i blocks = (solid.cells.array() + kBlockCells - 1) / kBlockCells;
  const int count = blocks.x() * blocks.y();
  std::atomic<int> next{0};
  const auto work = [&] {
    Found own;
    BlockSamples samples(field);
    for (int b = next++; b < count; b = next++) {
      fillBlock({b % blocks.x() * kBlockCells, b / blocks.x() * kBlockCells, z}, samples, solid, own);
    }
    return own;
  };
  std::vector<std::future<Found>> workers;
  const int threads = std::min(count, usableProcessors());
  for (int t = 0; t < threads; ++t) workers.push_back(std::async(std::launch::async, work));
  for (std::future<Found>& worker : workers) {
    const Found own = worker.get();
    found.partial.insert(found.partial.end(), own.partial.begin(), own.partial.end());
    found.slivers.insert(found.slivers.end(), own.slivers.begin(), own.slivers.end());
  }
}

bool isBefore(const PartialCell& a, const PartialCell& b) {
  return a.cell < b.cell;
}

void fillAll(const DistanceField& field, Solid& solid, const Progress& progress) {
  Found found;
  for (int z = 0; z < solid.cells.z(); z += kBlockCells) {
    fillLayer(field, z, solid, found);
    if (progress) progress("voxelise", std::min(1.0, static_cast<double>(z + kBlockCells) / solid.cells.z()));
  }
  // Sorted, so that sums round alike whichever thread found an entry.
  std::sort(found.partial.begin(), found.partial.end(), isBefore);
  std::sort(found.slivers.begin(), found.slivers.end(), isBefore);
  solid.partial = std::move(found.partial);
  giveSlivers(found.slivers, solid);
  if (!solid.partial.empty()) measureDepths(field, solid);
}

}  // namespace

Solid voxeliseByMoments(const DistanceField& field, const std::vector<std::string>& part_names, const Vector3d& min_m,
                        const Vector3d& max_m, double spacing_m, const NodePlanes& planes, const Progress& progress) {
  const auto fill = [&](double h, const Progress& reported) {
    Solid solid = emptySolid(min_m, max_m, h, part_names, planes);
    fillAll(field, solid, reported);
    return solid;
  };
  Solid solid = fill(spacing_m, progress);
  if (solid.filledCells() > 0) return solid;
  requireFinerSpacing(spacing_m, [&](double h) { return fill(h, {}).filledCells() > 0; });
  throw LatticeError("the body is empty: its distance field is not negative anywhere within its bounds");
}

}  // namespace viscera
