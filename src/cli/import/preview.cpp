// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/import/preview.h"

#include <algorithm>
#include <cmath>

#include "cli/import/preview_canvas.h"
#include "model/shape/organ/tissue.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

namespace viscera::cli {
namespace {

constexpr int kLongest = 768;                       ///< longer side of an image [pixels]
constexpr double kMargin = 0.06;                    ///< margin around organs for the letters, relative to the image
constexpr double kAmbient = 0.25;                   ///< ambient share of the light in a side view
constexpr double kLowest = 0.01, kHighest = 0.995;  ///< quantiles of the slices' values that become black and white
constexpr double kInside = 0.4;                     ///< brightness of an organ's interior if a slice has no grey values
constexpr Rgb kLatticeColor = {90, 130, 255};

/// Right and up directions of an image, in the scan's axes (x anterior, y left, z up).
struct View {
  std::string name;
  Vector3d right, up;
};

char letterOf(const Vector3d& direction) {
  Eigen::Index most = 0;
  direction.cwiseAbs().maxCoeff(&most);
  return direction[most] > 0 ? "ALS"[most] : "PRI"[most];
}

void mark(PreviewCanvas& canvas, const View& view) {
  canvas.letters(letterOf(-view.right), letterOf(view.right), letterOf(view.up), letterOf(-view.up));
}

/// Returns distinguishable colours, other than the blue of lattices. @param share  brightness, 0..1
Rgb colorOf(size_t organ, double share = 1) {
  constexpr double kColors[][3] = {{230, 90, 70},  {250, 200, 70}, {90, 200, 110},  {220, 120, 220}, {90, 210, 210},
                                   {240, 150, 60}, {170, 220, 60}, {240, 130, 160}, {200, 160, 110}, {150, 150, 150}};
  const auto& color = kColors[organ % std::size(kColors)];
  Rgb out;
  for (size_t c = 0; c < 3; ++c) out[c] = static_cast<uint8_t>(color[c] * share);
  return out;
}

void writeSide(const std::string& folder, const View& view, const std::vector<const TriangleMesh*>& organs,
               const Eigen::AlignedBox3d& box) {
  Matrix3d turn;
  turn << view.right.transpose(), -view.up.transpose(), view.right.cross(view.up).transpose();
  const Vector3d sizes = (turn * box.sizes()).cwiseAbs(), middle = turn * box.center();
  const double scale = kLongest * (1 - 2 * kMargin) / std::max({sizes.x(), sizes.y(), 1e-6});
  const auto pixels = [&](double size) { return static_cast<int>(std::lround(size * scale + 2 * kMargin * kLongest)); };
  PreviewCanvas canvas(pixels(sizes.x()), pixels(sizes.y()));
  const Vector3d shift(canvas.width() / 2.0, canvas.height() / 2.0, 0);
  for (size_t n = 0; n < organs.size(); ++n)
    for (const auto& t : organs[n]->triangles) {
      std::array<Vector3d, 3> corners;
      for (size_t c = 0; c < 3; ++c)
        corners[c] = scale * (turn * organs[n]->positions_m[t[c]].cast<double>() - middle) + shift;
      // y points down in the image, so front faces are clockwise there
      const Vector3d normal = (corners[2] - corners[0]).cross(corners[1] - corners[0]).normalized();
      canvas.triangle(corners, colorOf(n, kAmbient + (1 - kAmbient) * std::abs(normal.z())));
    }
  mark(canvas, view);
  canvas.write(folder + "/" + view.name + ".png");
}

/// A slice as an image: which axes of the volume point right and up, and whether they are reversed.
struct SliceView {
  View view;
  int axis, right, up;
  bool right_back, up_back;
};

/// Returns the body axis closest to each of the file's axes, jointly optimal: [axis] 0 anterior, 1 left, 2 up.
std::array<int, 3> nearestAxes(const Matrix3d& axes) {
  std::array<int, 3> order = {0, 1, 2}, best = order;
  double most = -1;
  do {
    double sum = 0;
    for (int a = 0; a < 3; ++a) sum += std::abs(axes.col(a).normalized()[order[static_cast<size_t>(a)]]);
    if (sum <= most) continue;
    most = sum;
    best = order;
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

SliceView sliceView(const VolumeFrame& frame, const View& view, int normal) {
  const std::array<int, 3> nearest = nearestAxes(frame.axes);
  const auto fileAxis = [&](const Vector3d& direction) {
    Eigen::Index most = 0;
    direction.cwiseAbs().maxCoeff(&most);
    return static_cast<int>(std::find(nearest.begin(), nearest.end(), most) - nearest.begin());
  };
  SliceView out{view, fileAxis(Vector3d::Unit(normal)), fileAxis(view.right), fileAxis(view.up), false, false};
  out.right_back = frame.axes.col(out.right).dot(view.right) < 0;
  out.up_back = frame.axes.col(out.up).dot(view.up) < 0;
  return out;
}

/// Maps positions to pixels of a slice.
class SlicePlane {
 public:
  SlicePlane(const ScanSlices& slices, const SliceView& view)
      : slices_(slices),
        view_(view),
        size_(slices.frame.size[view.right], slices.frame.size[view.up]),
        step_(slices.frame.spacing_m()[view.right], slices.frame.spacing_m()[view.up]),
        scale_(kLongest / size_.cast<double>().cwiseProduct(step_).maxCoeff()) {}

  PreviewCanvas canvas() const {
    const Eigen::Vector2d size = (size_.cast<double>().cwiseProduct(step_) * scale_).array().round().cwiseMax(1.0);
    return {static_cast<int>(size.x()), static_cast<int>(size.y())};
  }
  /// Returns the pixel of a position along the volume's axes [voxels].
  Eigen::Vector2d pixel(const Vector3d& voxel) const {
    const double right = voxel[view_.right] + 0.5, up = voxel[view_.up] + 0.5;
    return Eigen::Vector2d(view_.right_back ? size_.x() - right : right, view_.up_back ? up : size_.y() - up)
               .cwiseProduct(step_) *
           scale_;
  }
  float value(int x, int y) const {
    const auto along = [&](int axis, int pixel, bool back) {
      const int n = std::clamp(static_cast<int>((pixel + 0.5) / (scale_ * step_[axis])), 0, size_[axis] - 1);
      return back ? size_[axis] - 1 - n : n;
    };
    const int right = along(0, x, view_.right_back), up = along(1, y, !view_.up_back);
    const bool right_first = view_.right < view_.up;
    const size_t fast = static_cast<size_t>(right_first ? right : up),
                 slow = static_cast<size_t>(right_first ? up : right);
    return slices_.values[static_cast<size_t>(view_.axis)]
                         [fast + static_cast<size_t>(right_first ? size_.x() : size_.y()) * slow];
  }
  /// Draws the intersection of a surface with the slice.
  void outline(const TriangleMesh& mesh, const Vector3d& moved_m, const Rgb& color, PreviewCanvas& canvas) const {
    const Matrix3d inverse = slices_.frame.axes.inverse();
    for (const auto& t : mesh.triangles) {
      std::array<Vector3d, 3> corners;
      std::vector<Vector3d> ends;
      for (size_t c = 0; c < 3; ++c)
        corners[c] = inverse * (mesh.positions_m[t[c]].cast<double>() - moved_m - slices_.frame.origin);
      for (size_t c = 0; c < 3; ++c) {
        const Vector3d &a = corners[c], &b = corners[(c + 1) % 3];
        const double from = a[view_.axis] - slices_.at[view_.axis], to = b[view_.axis] - slices_.at[view_.axis];
        if ((from > 0) != (to > 0)) ends.push_back(a + (b - a) * from / (from - to));
      }
      if (ends.size() == 2) canvas.line(pixel(ends[0]), pixel(ends[1]), color);
    }
  }

 private:
  const ScanSlices& slices_;
  const SliceView& view_;
  Eigen::Vector2i size_;
  Eigen::Vector2d step_;
  double scale_;  ///< pixels per metre
};

/// Returns the values that become black and white.
std::array<float, 2> greyRange(const ScanSlices& slices) {
  std::vector<float> all;
  for (const std::vector<float>& values : slices.values)
    std::copy_if(values.begin(), values.end(), std::back_inserter(all), [](float v) { return std::isfinite(v); });
  if (all.empty()) return {0, 1};
  const auto at = [&](double share) {
    const auto n = all.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(all.size() - 1));
    std::nth_element(all.begin(), n, all.end());
    return *n;
  };
  const float low = at(kLowest), high = at(kHighest);
  return {low, high > low ? high : low + 1};
}

/// Returns the outer faces of a lattice's cells.
TriangleMesh outerFaces(const Solid& solid) {
  TriangleMesh mesh;
  const auto corner = [&](const Vector3i& node) {
    mesh.positions_m.push_back((solid.origin_m + solid.spacing_m * node.cast<double>()).cast<float>());
  };
  for (int z = 0; z < solid.cells.z(); ++z)
    for (int y = 0; y < solid.cells.y(); ++y)
      for (int x = 0; x < solid.cells.x(); ++x)
        for (int face = 0; face < 6 && solid.label(x, y, z) != 0; ++face) {
          const int axis = face / 2, side = face % 2;
          const Vector3i cell(x, y, z), next = cell + (2 * side - 1) * Vector3i::Unit(axis);
          if (solid.label(next.x(), next.y(), next.z()) != 0) continue;
          const Vector3i first = cell + side * Vector3i::Unit(axis), along = Vector3i::Unit((axis + 1) % 3),
                         across = Vector3i::Unit((axis + 2) % 3);
          const auto n = static_cast<uint32_t>(mesh.positions_m.size());
          for (const Vector3i& node :
               {first, Vector3i(first + along), Vector3i(first + across), Vector3i(first + along + across)})
            corner(node);
          mesh.triangles.push_back({n, n + 1, n + 2});
          mesh.triangles.push_back({n + 1, n + 3, n + 2});
        }
  return mesh;
}

void writeSides(const std::string& folder, const std::vector<const TriangleMesh*>& organs) {
  Eigen::AlignedBox3d box;
  for (const TriangleMesh* mesh : organs)
    for (const Vector3f& p : mesh->positions_m) box.extend(p.cast<double>());
  const Vector3d anterior = Vector3d::UnitX(), left = Vector3d::UnitY(), up = Vector3d::UnitZ();
  for (const View& view : {View{"front", left, up}, View{"left", -anterior, up}, View{"above", -left, anterior}})
    writeSide(folder, view, organs, box);
}

void writeSlices(const std::string& folder, const ScanSlices& slices, const std::vector<const TriangleMesh*>& organs,
                 const std::vector<TriangleMesh>& cells, const Vector3d& moved_m) {
  const Vector3d anterior = Vector3d::UnitX(), left = Vector3d::UnitY(), up = Vector3d::UnitZ();
  const View views[] = {
      {"slice_coronal", left, up}, {"slice_sagittal", -anterior, up}, {"slice_axial", left, anterior}};
  const auto [black, white] = greyRange(slices);
  for (int normal = 0; normal < 3; ++normal) {
    const SliceView view = sliceView(slices.frame, views[normal], normal);
    const SlicePlane plane(slices, view);
    PreviewCanvas canvas = plane.canvas();
    for (int y = 0; y < canvas.height(); ++y)
      for (int x = 0; x < canvas.width(); ++x) {
        const float value = plane.value(x, y);
        const auto grey = static_cast<uint8_t>(255 * std::clamp((value - black) / (white - black), 0.0F, 1.0F));
        if (slices.labels && value > 0) canvas.pixel(x, y, colorOf(static_cast<size_t>(value) - 1, kInside));
        if (!slices.labels && !std::isnan(value)) canvas.pixel(x, y, {grey, grey, grey});
      }
    for (const TriangleMesh& mesh : cells) plane.outline(mesh, moved_m, kLatticeColor, canvas);
    for (size_t n = 0; n < organs.size(); ++n) plane.outline(*organs[n], Vector3d::Zero(), colorOf(n), canvas);
    mark(canvas, view.view);
    canvas.write(folder + "/" + view.view.name + ".png");
  }
}

}  // namespace

Vector3d middleOf(const LabelVolume& map) {
  const Vector3i size = map.frame.size;
  Eigen::AlignedBox3d box;
  size_t voxel = 0;
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j) {
      const auto begin = map.labels.begin() + static_cast<std::ptrdiff_t>(voxel), end = begin + size.x();
      voxel += static_cast<size_t>(size.x());
      const auto labelled = [](uint8_t label) { return label != 0; };
      const auto first = std::find_if(begin, end, labelled);
      if (first == end) continue;
      const auto last = std::find_if(std::make_reverse_iterator(end), std::make_reverse_iterator(first), labelled);
      box.extend(Vector3d(static_cast<double>(first - begin), j, k));
      box.extend(Vector3d(static_cast<double>(last.base() - begin - 1), j, k));
    }
  return box.isEmpty() ? Vector3d((size.cast<double>() - Vector3d::Ones()) / 2) : box.center();
}

ScanSlices slicesOf(const LabelVolume& map) {
  ScanSlices out;
  out.frame = map.frame;
  out.labels = true;
  out.at = middleOf(map).cast<int>();
  const Vector3i size = map.frame.size;
  const Eigen::Array<size_t, 3, 1> stride(1, size.x(), static_cast<size_t>(size.x()) * static_cast<size_t>(size.y()));
  for (int axis = 0; axis < 3; ++axis) {
    const int fast = axis == 0 ? 1 : 0, slow = axis == 2 ? 1 : 2;
    for (int s = 0; s < size[slow]; ++s)
      for (int f = 0; f < size[fast]; ++f)
        out.values[static_cast<size_t>(axis)].push_back(
            map.labels[stride[axis] * static_cast<size_t>(out.at[axis]) + stride[fast] * static_cast<size_t>(f) +
                       stride[slow] * static_cast<size_t>(s)]);
  }
  return out;
}

SlicedSource::SlicedSource(SliceSource& source, const Vector3i& at) : source_(source) {
  slices.frame = source.frame();
  slices.at = at;
}

void SlicedSource::next(std::vector<float>& values) {
  source_.next(values);
  const Vector3i size = slices.frame.size;
  for (int j = 0; j < size.y(); ++j)
    slices.values[0].push_back(
        values[static_cast<size_t>(slices.at.x()) + static_cast<size_t>(size.x()) * static_cast<size_t>(j)]);
  const auto row = values.begin() + static_cast<std::ptrdiff_t>(size.x()) * slices.at.y();
  slices.values[1].insert(slices.values[1].end(), row, row + size.x());
  if (read_++ == slices.at.z()) slices.values[2] = values;
}

ScanSlices slicesAt(SliceSource& source, const Vector3d& position_m) {
  const VolumeFrame& frame = source.frame();
  const Vector3d voxel = (frame.axes.inverse() * (position_m - frame.origin)).array().round();
  if ((voxel.array() < 0).any() || (voxel.array() >= frame.size.cast<double>().array()).any()) return {};
  SlicedSource sliced(source, voxel.cast<int>());
  std::vector<float> values;
  for (int k = 0; k < frame.size.z(); ++k) sliced.next(values);
  return sliced.slices;
}

void writePreviews(const std::string& folder, const std::vector<const TriangleMesh*>& organs, const Scene& scene,
                   const ScanSlices& slices, std::vector<std::string>& notes) {
  writeSides(folder, organs);
  std::vector<TriangleMesh> cells;
  for (const BodyConfig& body : scene.bodies) {
    try {
      cells.push_back(outerFaces(makeTissue(body, scene.folder)->fill(body.spacing_m, {}).solid));
    } catch (const Error& error) {
      notes.push_back(body.name + " has no lattice in the previews: " + error.what());
    }
  }
  writeSlices(folder, slices, organs, cells, scene.bodies.at(0).position_m);
}

}  // namespace viscera::cli
