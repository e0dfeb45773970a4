// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/wounds/tetrahedron_walls.h"

#include <algorithm>
#include <cassert>

namespace viscera {

namespace {

uint32_t bitCount(uint32_t bits) {
  uint32_t count = 0;
  for (; bits != 0; bits &= bits - 1) ++count;
  return count;
}

uint8_t next(uint32_t corner) {
  return static_cast<uint8_t>((corner + 1) % 3);
}
uint8_t previous(uint32_t corner) {
  return static_cast<uint8_t>((corner + 2) % 3);
}

FaceVertex cornerOf(uint8_t corner) {
  return {FaceVertex::kCorner, corner, 0};
}
/// Beside a corner, on the edge to the next one or to the one before.
FaceVertex lipAhead(uint8_t corner) {
  return {FaceVertex::kLip, corner, corner};
}
FaceVertex lipBehind(uint8_t corner) {
  return {FaceVertex::kLip, corner, previous(corner)};
}

void addEnded(uint8_t edge, FacePieces& out) {
  const uint8_t i = edge, j = next(i), k = previous(i);
  const FaceVertex end{FaceVertex::kEnd, k, edge};
  out.triangles = {{{cornerOf(i), lipAhead(i), end}, i},
                   {{end, lipBehind(j), cornerOf(j)}, i},
                   {{end, cornerOf(j), cornerOf(k)}, i},
                   {{end, cornerOf(k), cornerOf(i)}, i}};
  out.borders = {{lipAhead(i), end, i}, {end, lipBehind(j), j}};
}

void addParted(uint8_t corner, FacePieces& out) {
  const uint8_t i = corner, j = next(i), k = previous(i);
  out.triangles = {{{cornerOf(i), lipAhead(i), lipBehind(i)}, i},
                   {{lipBehind(j), cornerOf(j), cornerOf(k)}, j},
                   {{lipBehind(j), cornerOf(k), lipAhead(k)}, j}};
  out.borders = {{lipAhead(i), lipBehind(i), i}, {lipAhead(k), lipBehind(j), j}};
}

void addStar(FacePieces& out) {
  for (uint8_t i = 0; i < 3; ++i) {
    const FaceVertex middle{FaceVertex::kMiddle, i, 0};
    out.triangles.push_back({{cornerOf(i), lipAhead(i), middle}, i});
    out.triangles.push_back({{cornerOf(i), middle, lipBehind(i)}, i});
    out.borders.push_back({lipAhead(i), middle, i});
    out.borders.push_back({middle, lipBehind(i), i});
  }
}

FacePieces makeFacePieces(uint32_t cut) {
  FacePieces out;
  switch (bitCount(cut)) {
    case 0:
      out.triangles = {{{cornerOf(0), cornerOf(1), cornerOf(2)}, 0}};
      break;
    case 1:
      addEnded(static_cast<uint8_t>(cut >> 1), out);
      break;
    case 2: {
      const uint32_t whole = ~cut & 7U;
      addParted(previous(whole >> 1), out);  // the corner across the whole edge
      break;
    }
    default:
      addStar(out);
  }
  return out;
}

bool isCut(uint32_t cut, size_t edge) {
  return (cut >> edge & 1U) != 0;
}

std::array<uint8_t, 4> componentsOf(uint32_t cut) {
  std::array<uint8_t, 4> component = {0, 1, 2, 3};
  for (int pass = 0; pass < 3; ++pass) {  // as long as the longest way through four corners
    for (size_t e = 0; e < 6; ++e) {
      const auto [a, b] = kTetrahedronEdges[e];
      if (!isCut(cut, e)) component[a] = component[b] = std::min(component[a], component[b]);
    }
  }
  return component;
}

/// A vertex of a face's border as the tetrahedron sees it.
WallVertex inTetrahedron(size_t face, const FaceVertex& v) {
  const auto& corners = kTetrahedronFaces[face];
  if (v.kind != FaceVertex::kLip)
    return {v.kind == FaceVertex::kEnd ? WallVertex::kEnd : WallVertex::kMiddle, static_cast<uint8_t>(face),
            corners[v.corner]};
  return {WallVertex::kLip, static_cast<uint8_t>(tetrahedronEdge(corners[v.edge], corners[next(v.edge)])),
          corners[v.corner]};
}

struct Border {
  WallVertex from, to;
  uint8_t corner;
};

std::vector<Border> bordersOf(uint32_t cut, bool& clean) {
  std::vector<Border> out;
  clean = true;
  for (size_t f = 0; f < 4; ++f) {
    const auto& corners = kTetrahedronFaces[f];
    uint32_t bits = 0;
    for (size_t i = 0; i < 3; ++i) bits |= isCut(cut, tetrahedronEdge(corners[i], corners[(i + 1) % 3])) ? 1U << i : 0U;
    clean = clean && (bits == 0 || bitCount(bits) == 2);
    for (const FacePieces::Border& b : facePieces(bits).borders)
      out.push_back({inTetrahedron(f, b.from), inTetrahedron(f, b.to), corners[b.corner]});
  }
  return out;
}

/// The lips around one side of a clean cut, in the order in which its wall has them, from the lowest edge on.
std::vector<WallVertex> loopOf(const std::vector<Border>& borders, const std::array<uint8_t, 4>& component,
                               uint8_t side) {
  std::vector<WallVertex> loop;
  const auto of_side = [&](const Border& b) { return component[b.corner] == side; };
  const Border* at = nullptr;
  for (const Border& b : borders)
    if (of_side(b) && (!at || b.to.at < at->to.at)) at = &b;
  while (loop.empty() || at->to.at != loop.front().at) {  // against the borders of the faces' pieces
    loop.push_back(at->to);
    at = &*std::find_if(borders.begin(), borders.end(),
                        [&](const Border& b) { return of_side(b) && b.to.at == at->from.at; });
  }
  return loop;
}

void addClean(const std::vector<Border>& borders, uint8_t side, TetrahedronWalls& out) {
  const std::vector<WallVertex> v = loopOf(borders, out.component, side);
  if (v.size() == 3) {
    out.triangles.push_back({{v[0], v[1], v[2]}, v[0].corner});
    return;
  }
  assert(v.size() == 4);
  out.diagonal = v[0].at;
  out.other_diagonal = std::min(v[1].at, v[3].at);
  out.triangles.push_back({{v[0], v[1], v[2]}, v[0].corner});
  out.triangles.push_back({{v[0], v[2], v[3]}, v[0].corner});
  out.others.push_back({{v[1], v[2], v[3]}, v[0].corner});
  out.others.push_back({{v[1], v[3], v[0]}, v[0].corner});
}

TetrahedronWalls makeWalls(uint32_t cut) {
  TetrahedronWalls out;
  out.component = componentsOf(cut);
  bool clean = false;
  const std::vector<Border> borders = bordersOf(cut, clean);
  if (borders.empty()) return out;
  if (clean) {
    addClean(borders, 0, out);
    for (uint8_t side = 1; side < 4; ++side)
      if (out.component[side] == side) addClean(borders, side, out);
    return out;
  }
  out.has_centre = true;
  for (const Border& b : borders) {
    const WallVertex centre{WallVertex::kCentre, out.component[b.corner], b.corner};
    out.triangles.push_back({{b.to, b.from, centre}, b.corner});
  }
  return out;
}

/// For every set of edges, by their bits.
template <size_t n, class Value>
std::array<Value, n> tableOf(Value (*make)(uint32_t cut)) {
  std::array<Value, n> out;
  for (uint32_t bits = 0; bits < n; ++bits) out[bits] = make(bits);
  return out;
}

}  // namespace

size_t tetrahedronEdge(size_t a, size_t b) {
  const auto [low, high] = std::minmax(a, b);
  return low == 0 ? high - 1 : low + high;
}

const FacePieces& facePieces(uint32_t cut) {
  static const std::array<FacePieces, 8> kPieces = tableOf<8>(makeFacePieces);
  return kPieces[cut];
}

const TetrahedronWalls& tetrahedronWalls(uint32_t cut) {
  static const std::array<TetrahedronWalls, 64> kWalls = tableOf<64>(makeWalls);
  return kWalls[cut];
}

}  // namespace viscera
