// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/body/skin_size.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "math/number_text.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

/// Returns the estimated number of pieces of a triangle. Halves of edges are up to a spacing long, so there are
/// between 2.3 and 9.2 triangles for each area of a spacing squared; slender ones are divided along their length.
double refinedTo(const TriangleMesh& mesh, const std::array<uint32_t, 3>& t, double longest_edge_m) {
  constexpr double kPerArea = 4;
  const auto at = [&](size_t corner) { return mesh.positions_m[t[corner]].cast<double>().eval(); };
  const Vector3d ab = at(1) - at(0), ac = at(2) - at(0), bc = at(2) - at(1);
  const double longest_m = std::max({ab.norm(), ac.norm(), bc.norm()});
  if (longest_m <= longest_edge_m) return 1;
  return longest_m / longest_edge_m + kPerArea * 0.5 * ab.cross(ac).norm() / (longest_edge_m * longest_edge_m);
}

}  // namespace

double refinedTriangles(const TriangleMesh& mesh, double longest_edge_m) {
  double sum = 0;
  for (const std::array<uint32_t, 3>& t : mesh.triangles) sum += refinedTo(mesh, t, longest_edge_m);
  return sum;
}

void requireSkinSize(const TriangleMesh& mesh, double spacing_m, int most) {
  const double all = refinedTriangles(mesh, spacing_m);
  if (all <= most) return;
  std::vector<double> of_part(std::max<size_t>(1, mesh.part_names.size()));
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const size_t part = std::min<size_t>(mesh.parts[t], of_part.size() - 1);
    of_part[part] += refinedTo(mesh, mesh.triangles[t], spacing_m);
  }
  const auto largest = std::max_element(of_part.begin(), of_part.end());
  const auto part = static_cast<size_t>(largest - of_part.begin());
  TextOut out;
  out << "the skin, refined to spacing_m " << spacing_m << ", would have about " << std::llround(all)
      << " triangles, more than import_limits.max_triangles = " << most;
  if (part < mesh.part_names.size())
    out << "; " << std::llround(*largest) << " of them in part '" << mesh.part_names[part] << "'";
  out << ". Remove stray parts from the file, use a larger spacing_m or skin: volume, or raise the limit";
  throw LatticeError(out.str());
}

}  // namespace viscera
