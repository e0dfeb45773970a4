// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "export/field_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "export/uncut_cells.h"
#include "math/vec4.h"
#include "viscera/layout/skin.h"
#include "viscera/math/error.h"
#include "viscera/session/tissue_processes.h"

namespace viscera {

namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

void add(std::vector<float>& out, const Vector3d& v) {
  for (int c = 0; c < 3; ++c) out.push_back(static_cast<float>(v[c]));
}

/// Calls visit(cell) for the uncut cells of a body. @param offset  of its slots in the state
template <class Visit>
void forCells(const Body& body, uint32_t offset, const HostState& state, const Visit& visit) {
  if (body.hasCells()) forUncutCells(body, CellStresses(body), offset, state, visit);
}

/// [slots] means over the uncut cells around a node; NaN where there is none.
struct NodeStrains {
  std::vector<float> energy, von_mises;
};
NodeStrains nodeStrains(const Model& model, const HostState& state) {
  NodeStrains out{std::vector<float>(model.slots()), std::vector<float>(model.slots())};
  std::vector<float> cells(model.slots());
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const uint32_t offset = model.slotOffset(b);
    forCells(model.bodies[b], offset, state, [&](const UncutCell& cell) {
      for (const uint32_t corner : cell.corners) {
        out.energy[offset + corner] += static_cast<float>(cell.stress.energy_j_per_m3);
        out.von_mises[offset + corner] += static_cast<float>(cell.stress.von_mises_pa);
        ++cells[offset + corner];
      }
    });
  }
  for (size_t slot = 0; slot < cells.size(); ++slot) {
    for (std::vector<float>* each : {&out.energy, &out.von_mises})
      (*each)[slot] = cells[slot] > 0 ? (*each)[slot] / cells[slot] : kUnknown;
  }
  return out;
}

/// Points of nodes, with their fields.
class NodePoints {
 public:
  NodePoints(const Model& model, FieldMesh& mesh) : mesh_(mesh), position_(model.slots(), kNone) {
    mesh_.of_points = {{"displacement", 3, {}}, {"velocity", 3, {}}, {"body", 1, {}}, {"part", 1, {}}};
  }
  uint32_t of(const Body& body, size_t b, uint32_t offset, uint32_t slot, const HostState& state) {
    uint32_t& position = position_[offset + slot];
    if (position != kNone) return position;
    position = static_cast<uint32_t>(mesh_.pointCount());
    const Vector3d u = xyz(state.displacement_m[offset + slot]);
    add(mesh_.points, restPosition(body, slot) + u);
    add(mesh_.of_points[0].values, u);
    add(mesh_.of_points[1].values, xyz(state.velocity_m_per_s[offset + slot]));
    mesh_.of_points[2].values.push_back(static_cast<float>(b));
    const bool labelled = slot < body.lattice.labels.size();
    mesh_.of_points[3].values.push_back(labelled ? static_cast<float>(body.lattice.labels[slot]) : 0);
    return position;
  }

 private:
  static constexpr uint32_t kNone = 0xffffffffu;
  FieldMesh& mesh_;
  std::vector<uint32_t> position_;
};

FieldMesh begun(const Session& session, uint32_t corners) {
  FieldMesh mesh;
  mesh.tick = session.tick();
  mesh.time_s = static_cast<double>(session.tick()) * session.tick_s();
  mesh.corners = corners;
  return mesh;
}

/// Returns the velocity of a vertex: mean of the nodes that it is bound to.
Vector3d velocityOf(const layout::SkinBinding& binding, uint32_t offset, const HostState& state) {
  const Vector3d first = xyz(state.velocity_m_per_s[offset + binding.slot0]);
  if (binding.springs & (layout::kOneToOneBit | layout::kOneNodeBit | layout::kInCellBit)) return first;
  return static_cast<double>(binding.weights.x) * first +
         static_cast<double>(binding.weights.y) * xyz(state.velocity_m_per_s[offset + binding.slot1]) +
         static_cast<double>(binding.weights.z) * xyz(state.velocity_m_per_s[offset + binding.slot2]);
}

}  // namespace

FieldMesh skinFields(const Session& session, const VisibleMesh& skin) {
  const HostState state = session.solver().readState();
  const Model& model = session.model();
  const NodeStrains strains = nodeStrains(model, state);
  FieldMesh mesh = begun(session, 3);
  mesh.points = skin.positions_m;
  mesh.cells = skin.topology->triangles;
  mesh.of_points = {{"displacement", 3, {}},  {"velocity", 3, {}},  {"normal", 3, {}},
                    {"strain_energy", 1, {}}, {"von_mises", 1, {}}, {"part", 1, {}}};
  for (size_t v = 0; v < skin.vertices(); ++v) add(mesh.of_points[2].values, skin.normal(v).cast<double>());
  size_t v = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const uint32_t offset = model.slotOffset(b);
    for (size_t i = 0; i < body.skin.bindings.size() && v < skin.vertices(); ++i, ++v) {
      const layout::SkinBinding& binding = body.skin.bindings[i];
      add(mesh.of_points[0].values, (skin.position_m(v) - body.skin.mesh.positions_m[i].cast<float>()).cast<double>());
      add(mesh.of_points[1].values, velocityOf(binding, offset, state));
      mesh.of_points[3].values.push_back(strains.energy[offset + binding.slot0]);
      mesh.of_points[4].values.push_back(strains.von_mises[offset + binding.slot0]);
      const bool labelled = binding.slot0 < body.lattice.labels.size();
      mesh.of_points[5].values.push_back(labelled ? static_cast<float>(body.lattice.labels[binding.slot0]) : 0);
    }
  }
  // Of vertices that wounds have added only the position is known.
  for (MeshField& field : mesh.of_points)
    field.values.resize(static_cast<size_t>(field.components) * skin.vertices(), kUnknown);
  if (!skin.colors.empty()) mesh.of_points.push_back({"color", 3, {}});
  for (const uint32_t color : skin.colors)
    for (const int shift : {0, 8, 16})
      mesh.of_points.back().values.push_back(static_cast<float>(color >> shift & 255U) / 255);
  mesh.of_cells = {{"body", 1, {}}, {"wound", 1, {}}};
  for (const VisiblePatch& patch : skin.topology->patches) {
    mesh.of_cells[0].values.insert(mesh.of_cells[0].values.end(), patch.count, static_cast<float>(patch.body));
    mesh.of_cells[1].values.insert(mesh.of_cells[1].values.end(), patch.count,
                                   patch.kind == SurfaceKind::kWound ? 1.0f : 0.0f);
  }
  return mesh;
}

FieldMesh latticeFields(const Session& session) {
  // Order of the corners of a hexahedron in the file, from corners with x first.
  constexpr std::array<size_t, 8> kAround = {0, 1, 3, 2, 4, 5, 7, 6};
  const HostState state = session.solver().readState();
  const Model& model = session.model();
  FieldMesh mesh = begun(session, 8);
  NodePoints points(model, mesh);
  mesh.of_cells = {{"body", 1, {}},       {"part", 1, {}},       {"strain_energy", 1, {}}, {"von_mises", 1, {}},
                   {"stress_max", 1, {}}, {"stress_mid", 1, {}}, {"stress_min", 1, {}}};
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const uint32_t offset = model.slotOffset(b);
    forCells(body, offset, state, [&](const UncutCell& cell) {
      for (const size_t corner : kAround) mesh.cells.push_back(points.of(body, b, offset, cell.corners[corner], state));
      mesh.of_cells[0].values.push_back(static_cast<float>(b));
      const bool labelled = !body.lattice.cell_labels.empty();
      mesh.of_cells[1].values.push_back(labelled ? static_cast<float>(body.lattice.cell_labels[cell.lowest]) : 0);
      mesh.of_cells[2].values.push_back(static_cast<float>(cell.stress.energy_j_per_m3));
      mesh.of_cells[3].values.push_back(static_cast<float>(cell.stress.von_mises_pa));
      for (int i = 0; i < 3; ++i)
        mesh.of_cells[static_cast<size_t>(4 + i)].values.push_back(static_cast<float>(cell.stress.principal_pa[i]));
    });
  }
  if (mesh.cells.empty()) throw Error("--export lattice: no body has cells; export its skin or its network");
  return mesh;
}

FieldMesh networkFields(const Session& session) {
  const HostState state = session.solver().readState();
  const Model& model = session.model();
  FieldMesh mesh = begun(session, 2);
  NodePoints points(model, mesh);
  mesh.of_cells = {{"body", 1, {}}, {"strain_energy", 1, {}}, {"force", 1, {}}};
  forUncutSprings(model, state, [&](size_t b, const NetworkSpring& spring, const Vector3d& step_m) {
    const Body& body = model.bodies[b];
    const uint32_t offset = model.slotOffset(b);
    mesh.cells.push_back(points.of(body, b, offset, spring.a, state));
    mesh.cells.push_back(points.of(body, b, offset, spring.b, state));
    const double longer_m = step_m.norm() - spring.rest_length_m;
    mesh.of_cells[0].values.push_back(static_cast<float>(b));
    mesh.of_cells[1].values.push_back(static_cast<float>(0.5 * spring.stiffness_n_per_m * longer_m * longer_m));
    mesh.of_cells[2].values.push_back(static_cast<float>(spring.stiffness_n_per_m * longer_m));
  });
  if (mesh.cells.empty()) throw Error("--export network: no body has explicit connections; export its lattice");
  return mesh;
}

FieldMesh sutureFields(const Session& session) {
  FieldMesh mesh = begun(session, 2);
  mesh.of_cells = {{"suture", 1, {}}, {"tension", 1, {}}, {"needle", 1, {}}};
  const auto link = [&](size_t suture, size_t from, double tension_n, bool needle) {
    mesh.cells.insert(mesh.cells.end(), {static_cast<uint32_t>(from), static_cast<uint32_t>(from + 1)});
    mesh.of_cells[0].values.push_back(static_cast<float>(suture));
    mesh.of_cells[1].values.push_back(static_cast<float>(tension_n));
    mesh.of_cells[2].values.push_back(needle ? 1 : 0);
  };
  for (size_t p = 0; p < suturePieces(session); ++p) {
    const size_t first = mesh.pointCount();
    for (const Vector3d& position : suturePositions(session, p)) add(mesh.points, position);
    const std::vector<double> tensions_n = sutureTensions_n(session, p);
    for (size_t i = 0; i < tensions_n.size(); ++i) link(sutureOf(session, p), first + i, tensions_n[i], false);
  }
  for (size_t t = 0; t < session.scene().sutures.size(); ++t) {
    const size_t tip = mesh.pointCount();
    for (const Vector3d& position : needlePositions(session, t)) add(mesh.points, position);
    for (size_t i = tip; i + 1 < mesh.pointCount(); ++i) link(t, i, 0, true);
  }
  if (mesh.cells.empty()) throw Error("--export sutures: the scene has no sutures; add sutures[]");
  return mesh;
}

void toFrame(ExportFrame frame, const Vector3d& scan_origin_m, Vectors what, std::vector<float>& vectors) {
  if (frame == ExportFrame::kRos) return;
  const double scale = what == Vectors::kDirections ? 1 : 1000;
  const Vector3d origin = what == Vectors::kPositions ? scan_origin_m : Vector3d::Zero();
  for (size_t i = 0; i + 2 < vectors.size(); i += 3) {
    const Vector3d at = scale * (origin + Vector3d(vectors[i], vectors[i + 1], vectors[i + 2]));
    vectors[i] = static_cast<float>(at.y());
    vectors[i + 1] = static_cast<float>(-at.x());
    vectors[i + 2] = static_cast<float>(at.z());
  }
}

void toFrame(ExportFrame frame, const Vector3d& scan_origin_m, FieldMesh& mesh) {
  toFrame(frame, scan_origin_m, Vectors::kPositions, mesh.points);
  for (MeshField& field : mesh.of_points) {
    if (field.components == 3 && field.name != "color")
      toFrame(frame, scan_origin_m, field.name == "normal" ? Vectors::kDirections : Vectors::kArrows, field.values);
  }
}

}  // namespace viscera
