// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "python/session_binding.h"

#include <cstring>

#include <pybind11/stl.h>

#include "export/field_mesh.h"
#include "python/arrays.h"
#include "python/fact_dicts.h"
#include "python/node_arrays.h"
#include "python/stepped.h"
#include "python/stylus_binding.h"
#include "viscera/math/state_hash.h"

namespace viscera::python {

namespace {

constexpr int64_t kMostTicks = 1'000'000'000;  // limit of one call: eleven days at 1 kHz
constexpr int kMostThreads = 1024;             // as in `viscera sweep --jobs`

using Skin = const SurfaceFrame;
using Class = py::class_<Stepped, std::shared_ptr<Stepped>>;

py::object vec4s(const std::vector<layout::vec4>& values, const std::shared_ptr<const HostState>& state) {
  auto* kept = new std::shared_ptr<const HostState>(state);
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::shared_ptr<const HostState>*>(p); });
  const auto* first = reinterpret_cast<const float*>(values.data());
  return view(first, {static_cast<py::ssize_t>(values.size()), 3}, {sizeof(layout::vec4), sizeof(float)}, owner);
}

std::vector<float> normals(const Skin& skin) {
  std::vector<float> out;
  out.reserve(3 * skin.vertices());
  for (size_t v = 0; v < skin.vertices(); ++v) {
    const Vector3f normal = skin.normal(v);
    out.insert(out.end(), normal.data(), normal.data() + 3);
  }
  return out;
}

/// Returns a number of its patch for every triangle.
template <class T, class Of>
std::vector<T> ofTriangles(const VisibleTopology& topology, Of&& of) {
  std::vector<T> out(topology.triangleCount());
  for (const VisiblePatch& patch : topology.patches)
    std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(patch.first), patch.count, static_cast<T>(of(patch)));
  return out;
}

std::vector<uint32_t> usedVertices(const VisibleTopology& topology) {
  std::vector<bool> used(topology.vertices);
  for (const uint32_t vertex : topology.triangles) {
    if (vertex >= used.size()) used.resize(vertex + size_t{1});
    used[vertex] = true;
  }
  std::vector<uint32_t> out;
  for (uint32_t v = 0; v < used.size(); ++v) {
    if (used[v]) out.push_back(v);
  }
  return out;
}

py::object triple(const Vector3d& v) {
  return arrayOf({v.x(), v.y(), v.z()});
}

py::list contacts(const Frame& frame, size_t styluses) {
  constexpr const char* kKinds[] = {"free", "pushes", "holds", "pierces", "pulls"};
  py::list out;
  for (size_t s = 0; s < styluses; ++s) {
    const TickContact& contact = frame.contacts[s];
    py::dict one;
    one["kind"] = kKinds[static_cast<size_t>(contact.kind)];
    one["from_m"] = triple(contact.from_m);
    one["to_m"] = triple(contact.to_m);
    one["force_n"] = triple(contact.reaction.force_n);
    one["torque_nm"] = triple(contact.reaction.torque_nm);
    one["limit_n"] = contact.limit_n;
    one["touched"] = frame.has_stats ? frame.stats.touched[s] : 0;
    one["held"] = frame.has_stats ? frame.stats.grabbed[s] : 0;
    one["inside"] = frame.inside[s];
    one["speed_limited"] = frame.speed_limited[s];
    one["saturated"] = frame.reactions[s].saturated;
    out.append(one);
  }
  return out;
}

double ofBits(uint32_t bits) {
  float out;
  std::memcpy(&out, &bits, sizeof out);
  return static_cast<double>(out);
}

/// Data for the diagnostics, copied while no step runs.
struct Facts {
  layout::TickStats stats{};  ///< statistics of the last tick; zero before the first
  Counters counters;
  Extremes extremes;
  Health health;
  double dt_s = 0, dt_safe_s = 0, dt_limit_s = 0;
  size_t nodes = 0, springs = 0;
  std::string backend, stepped_by;
  FactGroups processes;
};

Facts factsOf(Stepped::Core& core) {
  Facts out;
  out.stats = core.session->drain().stats;
  const Session& session = *core.session;
  out.counters = session.counters();
  out.extremes = session.extremes();
  out.health = session.solver().health();
  out.dt_s = session.solver().dt_s();
  out.dt_safe_s = session.solver().dtSafe_s();
  out.dt_limit_s = session.solver().dtLimit_s();
  out.nodes = session.model().activeNodes();
  out.springs = session.model().springs();
  out.backend = session.solver().backend();
  out.stepped_by = session.backendNote();
  out.processes = session.facts();
  return out;
}

/// Returns the diagnostics. Names and meanings are those of metrics.json, then of the topic /diagnostics; others are
/// specific to this module.

py::dict diagnostics(const Facts& facts) {
  py::dict out;
  out["nodes"] = facts.nodes;
  out["springs"] = facts.springs;
  out["springs_cut"] = facts.stats.springs_cut;
  out["steps"] = facts.counters.substeps;
  out["dt_s"] = facts.dt_s;
  out["dt_safe_s"] = facts.dt_safe_s;
  out["dt_limit_s"] = facts.dt_limit_s;
  out["max_stretch"] = facts.extremes.max_stretch;
  out["max_speed_m_per_s"] = facts.extremes.max_speed_m_per_s;
  out["nonfinite"] = facts.extremes.nonfinite;
  out["nodes_crowded"] = facts.extremes.crowded;
  out["roll_backs"] = facts.extremes.roll_backs;
  out["ticks_speed_limited"] = facts.extremes.speed_limited;
  out["peak_force_n"] = facts.extremes.peak_force_n;
  out["backend"] = facts.backend;
  out["stepped_by"] = facts.stepped_by;
  out["ticks"] = facts.counters.ticks;
  out["recovering"] = facts.health.recovering;
  out["strained"] = facts.health.strained;
  out["kinetic_energy_j"] = facts.health.kinetic_j;
  out["elastic_energy_j"] = facts.health.elastic_j;
  out["springs_collapsed"] = facts.stats.collapsed;
  out["cells_inverted"] = facts.stats.inverted;
  out["stretch_now"] = ofBits(facts.stats.max_stretch_bits);
  out["speed_now_m_per_s"] = ofBits(facts.stats.max_speed_bits);
  addFacts(facts.processes, out);
  return out;
}

py::dict fields(const Stepped& stepped, const std::string& of) {
  if (of != "lattice" && of != "network")
    throw py::value_error("fields: must be 'lattice' or 'network'; found '" + of + "'");
  FieldMesh mesh = stepped.with([&](Stepped::Core& core) {
    return of == "lattice" ? latticeFields(*core.session) : networkFields(*core.session);
  });
  py::dict out, of_points, of_cells;
  for (MeshField& field : mesh.of_points)
    of_points[field.name.c_str()] = given(std::move(field.values), field.components);
  for (MeshField& field : mesh.of_cells)
    of_cells[field.name.c_str()] = given(std::move(field.values), field.components);
  out["points_m"] = given(std::move(mesh.points), 3);
  out["cells"] = given(std::move(mesh.cells), mesh.corners);
  out["of_points"] = of_points;
  out["of_cells"] = of_cells;
  return out;
}

py::object picture(const Stepped& stepped, size_t camera, const std::string& kind) {
  constexpr const char* kNames[kPictureKinds] = {"color", "right", "depth", "labels"};
  for (size_t k = 0; k < kPictureKinds; ++k) {
    if (kind != kNames[k]) continue;
    ImageFrame image = stepped.picture(camera, static_cast<PictureKind>(k));
    const py::ssize_t h = image.height, w = image.width;
    if (k == 2) return given(std::move(image.depths_m), w);
    if (k == 3) return given(std::move(image.labels), w);
    const py::object flat = given(std::move(image.rgb), 3 * w);
    return flat.attr("reshape")(h, w, 3);
  }
  throw py::value_error("picture: kind: must be color, right, depth or labels; found '" + kind + "'");
}

void bindSkin(py::module_& module) {
  auto skin = py::class_<SurfaceFrame, std::shared_ptr<SurfaceFrame>>(
      module, "Skin", "The deformed skin of one tick. Arrays without a copy are read-only and keep it alive.");
  skin.def_readonly("tick", &SurfaceFrame::tick);
  skin.def_property_readonly(
      "positions_m", [](const py::object& self) { return rows(self.cast<Skin&>().positions_m, 3, self); },
      "(vertices, 3) float32 [m], tissue frame: positions of used and spare vertices; no copy.");
  skin.def_property_readonly(
      "packed_normals",
      [](const py::object& self) {
        const auto& packed = self.cast<Skin&>().normals;
        return view(packed.data(), {static_cast<py::ssize_t>(packed.size())}, {sizeof(uint32_t)}, self);
      },
      "(vertices,) uint32: normals as three signed 10-bit fractions, x in the low bits; no copy.");
  skin.def_property_readonly(
      "normals", [](const Skin& s) { return given(normals(s), 3); },
      "(vertices, 3) float32: unpacked normals, of length 1 to within 1/511; a copy.");
  skin.def_property_readonly(
      "triangles", [](const py::object& self) { return rows(self.cast<Skin&>().topology->triangles, 3, self); },
      "(triangles, 3) uint32: vertices of each triangle, counter-clockwise seen from outside; no copy.");
  skin.def_property_readonly(
      "bodies_of_triangles",
      [](const Skin& s) {
        return given(ofTriangles<uint32_t>(*s.topology, [](const VisiblePatch& p) { return p.body; }), 1);
      },
      "(triangles,) uint32: index of the body; a copy.");
  skin.def_property_readonly(
      "wounds",
      [](const Skin& s) {
        return given(ofTriangles<uint8_t>(*s.topology,
                                          [](const VisiblePatch& p) { return p.kind == SurfaceKind::kWound; }),
                     1)
            .attr("view")("bool");
      },
      "(triangles,) bool: whether a triangle is a wall that a cut has opened; a copy.");
  skin.def_property_readonly(
      "used", [](const Skin& s) { return given(usedVertices(*s.topology), 1); },
      "(n,) uint32, ascending: vertices that triangles have now. Other rows of positions_m are kept for edges that a "
      "cut "
      "would split; numbers of vertices stay as they are. A copy.");
  skin.def("__repr__", [](const Skin& s) {
    return "<viscera.Skin of tick " + std::to_string(s.tick) + ", " + std::to_string(usedVertices(*s.topology).size()) +
           " vertices, " + std::to_string(s.topology->triangleCount()) + " triangles>";
  });
  skin.def_property_readonly(
      "revision", [](const Skin& s) { return s.topology->revision; },
      "Revision of the triangles; it differs when the triangles differ.");
}

std::string sessionText(const Stepped& stepped) {
  if (stepped.closed()) return "<viscera.Session, closed>";
  try {
    return stepped.with([](Stepped::Core& core) {
      const Session& session = *core.session;
      return "<viscera.Session of '" + session.scene().name + "', tick " + std::to_string(session.tick()) + ", " +
             std::to_string(session.model().activeNodes()) + " nodes, " + session.solver().backend() + ">";
    });
  } catch (const Error& error) {  // the session belongs to another process
    return std::string("<viscera.Session: ") + error.what() + ">";
  }
}

size_t stylusCount(const Stepped::Core& core) {
  return core.session->styluses().size();
}

void bindSteps(Class& session) {
  session.def(
      "step",
      [](const Stepped& s, const py::object& styluses, int64_t n) {
        if (n < 1 || n > kMostTicks)
          throw py::value_error("n: must be 1 .. " + std::to_string(kMostTicks) + "; found " + std::to_string(n));
        const size_t count = s.with(stylusCount);
        s.step(samplesOf(styluses, count), n);
      },
      py::arg("styluses") = py::none(), py::arg("n") = 1,
      "Steps n ticks with the given styluses: None, a Stylus, or a list of Stylus or None, at most one for each "
      "stylus of the scene. The GIL is released.");
  session.def("reset", &Stepped::reset, "Returns the tissue to rest, at tick 0.");
  session.def(
      "state", [](const Stepped& s) { return py::bytes(s.state()); },
      "Saved state as bytes, in the format of `viscera run --save`.");
  session.def(
      "restore", [](const Stepped& s, const py::bytes& state) { s.restore(state); }, py::arg("state"),
      "Continues from a state of state(), bit for bit; raises Error if scene, tissue, backend or version differ.");
  session.def("__repr__", &sessionText);
  session.def("close", &Stepped::close, "Ends the session; arrays taken from it stay valid.");
  session.def_property_readonly("closed", &Stepped::closed);
  session.def("__enter__", [](const py::object& self) { return self; });
  session.def("__exit__", [](Stepped& s, const py::args&) { s.close(); });
}

void bindMeasures(Class& session) {
  session.def_property_readonly(
      "hash",
      [](const Stepped& s) { return StateHash::text(s.with([](Stepped::Core& c) { return c.session->stateHash(); })); },
      "Hash of the state, 16 hexadecimal digits, as `viscera run` prints it.");
  session.def_property_readonly(
      "tick", [](const Stepped& s) { return s.with([](Stepped::Core& c) { return c.session->tick(); }); });
  session.def_property_readonly(
      "tick_s", [](const Stepped& s) { return s.with([](Stepped::Core& c) { return c.session->tick_s(); }); },
      "Length of a tick [s].");
  session.def_property_readonly(
      "time_s",
      [](const Stepped& s) {
        return s.with([](Stepped::Core& c) { return static_cast<double>(c.session->tick()) * c.session->tick_s(); });
      },
      "Time simulated since the start or the last reset [s].");
  session.def_property_readonly(
      "wrenches",
      [](const Stepped& s) {
        return given(s.with([](Stepped::Core& c) { return wrenchesOf(c.last, stylusCount(c)); }), 6);
      },
      "(styluses, 6) float64: force [N] and torque about the tip [N m] on each, tissue frame, within the scene's "
      "limits; zero before the first step, and after reset() and restore(). A copy.");
  session.def_property_readonly(
      "contacts",
      [](const Stepped& s) {
        const auto [frame, count] = s.with([](Stepped::Core& c) {
          Frame out;
          out.contacts = c.last.contacts, out.stats = c.last.stats, out.has_stats = c.last.has_stats;
          out.inside = c.last.inside, out.speed_limited = c.last.speed_limited, out.reactions = c.last.reactions;
          return std::pair(std::move(out), stylusCount(c));
        });
        return contacts(frame, count);
      },
      "One dict per stylus: contacts of its tip in the last tick, its motion, unlimited mean force and torque, nodes "
      "touched and held.");
  session.def_property_readonly(
      "diagnostics", [](const Stepped& s) { return diagnostics(s.with(factsOf)); },
      "Dict with the names of metrics.json of `viscera run` (nodes, springs_cut, dt_s, max_stretch ...), a dict for "
      "each "
      "of sutures, clips, burns, bleeding and blades that the scene has, and further values of /diagnostics: ticks, "
      "recovering, strained, kinetic_energy_j, elastic_energy_j, springs_collapsed, cells_inverted; of the last tick: "
      "stretch_now, speed_now_m_per_s.");
}

void bindArrays(Class& session) {
  session.def_property_readonly(
      "nodes",
      [](const Stepped& s) {
        return given(s.with([](Stepped::Core& c) { return activeSlots(c.session->model()); }), 1);
      },
      "(nodes,) uint32: slots that have a node; the others are empty. A copy.");
  session.def_property_readonly(
      "rest_m",
      [](const Stepped& s) {
        return given(s.with([](Stepped::Core& c) { return restPositions(c.session->model()); }), 3);
      },
      "(slots, 3) float32 [m]: positions at rest, NaN in empty slots. A copy.");
  session.def_property_readonly(
      "positions_m",
      [](const Stepped& s) {
        const auto state = s.nodes();
        return given(s.with([&](Stepped::Core& c) { return positions(c.session->model(), *state); }), 3);
      },
      "(slots, 3) float32 [m]: positions, NaN in empty slots. A copy, because the library stores displacements.");
  session.def_property_readonly(
      "displacement_m",
      [](const Stepped& s) {
        const auto state = s.nodes();
        return vec4s(state->displacement_m, state);
      },
      "(slots, 3) float32 [m]: displacements from rest at this tick; created once per tick, then shared, "
      "read-only.");
  session.def_property_readonly(
      "velocity_m_per_s",
      [](const Stepped& s) {
        const auto state = s.nodes();
        return vec4s(state->velocity_m_per_s, state);
      },
      "(slots, 3) float32 [m/s]: velocities, shared as displacement_m.");
  session.def(
      "skin", [](const Stepped& s) { return std::const_pointer_cast<SurfaceFrame>(s.skin()); },
      "The deformed skin at the present tick.");
  session.def(
      "fields", &fields, py::arg("of") = "lattice",
      "Dict of points, cells and their fields, as `viscera run --export` writes them: stress, strain energy ... "
      "of: 'lattice' or 'network'. The arrays own their memory.");
  session.def("picture", &picture, py::arg("camera") = 0, py::arg("kind") = "color",
              "Image of a camera at the present tick. kind: color, right: (h, w, 3) uint8; depth: (h, w) float32 [m]; "
              "labels: (h, w) uint8. Needs pictures=True.");
}

}  // namespace

void bindSession(py::module_& module) {
  bindSkin(module);
  Class session(module, "Session", "A running scene. Calls may come from any thread; they wait for each other.");
  session.def(
      py::init([](const SceneSource& scene, const std::optional<std::string>& backend, int threads, bool pictures) {
        if (threads < 0 || threads > kMostThreads)
          throw py::value_error("threads: must be 0 .. " + std::to_string(kMostThreads) + "; found " +
                                std::to_string(threads));
        return std::make_shared<Stepped>(scene, backend, threads, pictures);
      }),
      py::arg("scene"), py::arg("backend") = py::none(), py::arg("threads") = 0, py::arg("pictures") = false,
      "backend: as solver.backend; None: as in the scene, and without pictures the CPU unless the scene says gpu. "
      "threads: 0: as in the scene. pictures: creates an OpenGL context, which each call makes current.");
  bindSteps(session);
  bindMeasures(session);
  bindArrays(session);
}

}  // namespace viscera::python
