// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "python/vector_binding.h"

#include <pybind11/stl.h>

#include "python/arrays.h"
#include "python/node_arrays.h"
#include "python/stepped_vector.h"
#include "python/stylus_binding.h"
#include "viscera/math/state_hash.h"

namespace viscera::python {

namespace {

constexpr int kMostSessions = 4096, kMostVectorThreads = 1024;
constexpr int64_t kMostVectorTicks = 1'000'000'000;  // limit of one call: eleven days at 1 kHz
constexpr py::ssize_t kPositionNumbers = 3, kPoseNumbers = 7, kVectorButtons = 2;

using VectorClass = py::class_<SteppedVector>;
using Group = SteppedVector::Group;

/// Returns a shape in Python's format.
std::string shapeOf(const std::vector<py::ssize_t>& shape) {
  return py::str(py::tuple(py::cast(shape)));
}

/// Returns an array of exactly this shape, of booleans or of numbers. @throws ValueError, TypeError
template <class T>
Given<T> shaped(const py::object& given, const std::vector<py::ssize_t>& shape, const char* what) {
  constexpr bool kFlags = std::is_same_v<T, bool>;
  const auto refused = [&] {
    return py::type_error(std::string(what) + ": must be an array of " + (kFlags ? "True and False" : "whole numbers"));
  };
  Given<T> out;
  try {
    const py::object any = asArray(given, "");
    const auto kind = any.attr("dtype").attr("kind").cast<std::string>();
    if (kind != "b" && (kFlags || kind != "i")) throw refused();
    out = Given<T>(any, kFlags ? "bool" : "int64");
  } catch (const py::error_already_set&) {
    throw refused();
  }
  if (out.shape() != shape)
    throw py::value_error(std::string(what) + ": must have shape " + shapeOf(shape) + "; found " +
                          shapeOf(out.shape()));
  return out;
}

std::vector<StylusSamples> samplesOf(const Group& group, const py::object& poses, const py::object& buttons,
                                     const py::object& present) {
  std::vector<StylusSamples> out(group.cores.size());
  if (poses.is_none()) {
    if (!buttons.is_none() || !present.is_none()) throw py::value_error("buttons, present: given without poses");
    return out;
  }
  const auto count = static_cast<py::ssize_t>(out.size()), styluses = static_cast<py::ssize_t>(group.styluses);
  Given<double> numbers;
  try {
    numbers = Given<double>(poses, "float64");
  } catch (const py::error_already_set&) {
    throw py::type_error("poses: must be an array of numbers");
  }
  const py::ssize_t width = numbers.ndim() == 3 ? numbers.shape(2) : 0;
  if ((width != kPositionNumbers && width != kPoseNumbers) || numbers.shape(0) != count || numbers.shape(1) != styluses)
    throw py::value_error("poses: must have shape (" + std::to_string(count) + ", " + std::to_string(styluses) +
                          ", 3 or 7); found " + shapeOf(numbers.shape()));
  Given<bool> pressed, there;
  if (!buttons.is_none()) pressed = shaped<bool>(buttons, {count, styluses, kVectorButtons}, "buttons");
  if (!present.is_none()) there = shaped<bool>(present, {count, styluses}, "present");
  constexpr double kUpright[4] = {0, 0, 0, 1};
  for (py::ssize_t n = 0; n < count; ++n) {
    for (py::ssize_t s = 0; s < styluses; ++s) {
      if (!present.is_none() && !there.at(n, s)) continue;
      const double* pose = numbers.data(n, s, 0);
      StylusSample& sample = out[static_cast<size_t>(n)][static_cast<size_t>(s)];
      sample = sampleOf(pose, width == kPoseNumbers ? pose + kPositionNumbers : kUpright);
      if (!buttons.is_none()) sample.button1 = pressed.at(n, s, 0), sample.button2 = pressed.at(n, s, 1);
    }
  }
  return out;
}

std::vector<int64_t> ticksOf(const Group& group, const py::object& given) {
  std::vector<int64_t> out;
  if (py::isinstance<py::int_>(given)) {
    out.assign(group.cores.size(), given.cast<int64_t>());
  } else {
    const auto each = shaped<int64_t>(given, {static_cast<py::ssize_t>(group.cores.size())}, "n");
    out.assign(each.data(), each.data() + each.size());
  }
  for (const int64_t ticks : out) {
    if (ticks < 0 || ticks > kMostVectorTicks)
      throw py::value_error("n: must be 0 .. " + std::to_string(kMostVectorTicks) + "; found " + std::to_string(ticks));
  }
  return out;
}

/// Returns the chosen sessions: all for None, or those that are True in a mask.
std::vector<size_t> chosen(const Group& group, const py::object& which) {
  std::vector<size_t> out;
  Given<bool> mask;
  if (!which.is_none()) mask = shaped<bool>(which, {static_cast<py::ssize_t>(group.cores.size())}, "which");
  for (size_t s = 0; s < group.cores.size(); ++s) {
    if (which.is_none() || mask.at(static_cast<py::ssize_t>(s))) out.push_back(s);
  }
  return out;
}

/// Returns an array of the values of all sessions, with the sessions as leading axis. `of` returns the same number of
/// values for each.
template <class Of>
py::object stacked(const SteppedVector& vector, std::vector<py::ssize_t> shape, const Of& of) {
  using T = typename std::invoke_result_t<Of, Stepped::Core&>::value_type;
  const auto group = vector.group();
  std::vector<std::vector<T>> parts(group->cores.size());
  vector.each(chosen(*group, py::none()), [&](Stepped::Core& core, size_t s) { parts[s] = of(core); });
  std::vector<T> all;
  all.reserve(parts.size() * parts[0].size());
  for (const std::vector<T>& part : parts) all.insert(all.end(), part.begin(), part.end());
  shape.insert(shape.begin(), static_cast<py::ssize_t>(parts.size()));
  return given(std::move(all), 1).attr("reshape")(shape);
}

template <class Of>
py::object one(const SteppedVector& vector, const Of& of) {
  return stacked(vector, {}, [&](Stepped::Core& core) { return std::vector{of(core)}; });
}

/// Returns [styluses] values of the last tick.
template <class Of>
auto ofStyluses(const Stepped::Core& core, const Of& of) {
  std::vector<std::invoke_result_t<Of, const Frame&, size_t>> out;
  for (size_t s = 0; s < core.session->styluses().size(); ++s) out.push_back(of(core.last, s));
  return out;
}

const HostState& stateOf(Stepped::Core& core) {
  if (!core.nodes) core.nodes = std::make_shared<const HostState>(core.session->solver().readState());
  return *core.nodes;
}

std::vector<float> threes(const std::vector<layout::vec4>& values) {
  std::vector<float> out;
  out.reserve(3 * values.size());
  for (const layout::vec4& value : values) {
    const auto* first = reinterpret_cast<const float*>(&value);
    out.insert(out.end(), first, first + 3);
  }
  return out;
}

void bindVectorSteps(VectorClass& vector) {
  vector.def(
      "step",
      [](const SteppedVector& v, const py::object& poses, const py::object& buttons, const py::object& present,
         const py::object& n) {
        const auto group = v.group();
        v.step(samplesOf(*group, poses, buttons, present), ticksOf(*group, n));
      },
      py::arg("poses") = py::none(), py::arg("buttons") = py::none(), py::arg("present") = py::none(), py::arg("n") = 1,
      "Steps all sessions, side by side, with styluses that stay where they are; the GIL is released.\n"
      "poses: None, or (sessions, styluses, 3) positions [m], or (sessions, styluses, 7) with quaternions x, y, z, w. "
      "buttons: (sessions, styluses, 2) bool. present: (sessions, styluses) bool: which styluses are tracked. "
      "n: number of ticks, one number or (sessions,); 0: no tick.");
  vector.def(
      "reset",
      [](const SteppedVector& v, const py::object& which) {
        v.each(chosen(*v.group(), which), [](Stepped::Core& core, size_t) { Stepped::resetCore(core); });
      },
      py::arg("which") = py::none(), "Returns the tissue to rest, at tick 0. which: (sessions,) bool; None: all.");
  vector.def(
      "restore",
      [](const SteppedVector& v, const py::bytes& state, const py::object& which) {
        const std::string bytes = state;
        v.each(chosen(*v.group(), which), [&](Stepped::Core& core, size_t) { Stepped::restoreCore(core, bytes); });
      },
      py::arg("state"), py::arg("which") = py::none(),
      "Restores a saved state, as from vector[0].state(), in the sessions of `which`, (sessions,) bool; None: all.");
  vector.def("close", &SteppedVector::close, "Ends the vector; sessions taken out of it and arrays stay valid.");
  vector.def_property_readonly("closed", &SteppedVector::closed);
  vector.def("__enter__", [](const py::object& self) { return self; });
  vector.def("__exit__", [](SteppedVector& v, const py::args&) { v.close(); });
  vector.def("__repr__", [](const SteppedVector& v) {
    return v.closed() ? std::string("<viscera.VectorSession, closed>")
                      : "<viscera.VectorSession of " + std::to_string(v.sessions()) + " sessions>";
  });
  vector.def("__len__", [](const SteppedVector& v) { return v.group()->cores.size(); });
  vector.def(
      "__getitem__",
      [](const SteppedVector& v, py::ssize_t s) {
        const auto group = v.group();
        const auto count = static_cast<py::ssize_t>(group->cores.size());
        if (s < -count || s >= count)
          throw py::index_error("session " + std::to_string(s) + " of " + std::to_string(count));
        return std::make_shared<Stepped>(group->cores[static_cast<size_t>(s < 0 ? s + count : s)]);
      },
      "One of the sessions, as a Session; changes to it are changes in the vector.");
}

void bindVectorArrays(VectorClass& vector) {
  using Core = Stepped::Core;
  vector.def_property_readonly(
      "hashes",
      [](const SteppedVector& v) {
        std::vector<std::string> out(v.group()->cores.size());
        v.each(chosen(*v.group(), py::none()),
               [&](Core& c, size_t s) { out[s] = StateHash::text(c.session->stateHash()); });
        return out;
      },
      "List of the hashes of all sessions.");
  vector.def_property_readonly(
      "ticks", [](const SteppedVector& v) { return one(v, [](Core& c) { return c.session->tick(); }); },
      "(sessions,) uint64: ticks since the start or the last reset.");
  vector.def_property_readonly(
      "wrenches",
      [](const SteppedVector& v) {
        return stacked(v, {static_cast<py::ssize_t>(v.group()->styluses), 6},
                       [](Core& c) { return wrenchesOf(c.last, c.session->styluses().size()); });
      },
      "(sessions, styluses, 6) float64: wrenches, as Session.wrenches.");
  vector.def_property_readonly(
      "touched",
      [](const SteppedVector& v) {
        return stacked(v, {-1}, [](Core& c) {
          return ofStyluses(c, [](const Frame& f, size_t s) { return f.has_stats ? f.stats.touched[s] : 0u; });
        });
      },
      "(sessions, styluses) uint32: nodes that each tip touches.");
  vector.def_property_readonly(
      "held",
      [](const SteppedVector& v) {
        return stacked(v, {-1}, [](Core& c) {
          return ofStyluses(c, [](const Frame& f, size_t s) { return f.has_stats ? f.stats.grabbed[s] : 0u; });
        });
      },
      "(sessions, styluses) uint32: nodes that each tip holds.");
  vector.def_property_readonly(
      "rollbacks",
      [](const SteppedVector& v) { return one(v, [](Core& c) { return c.session->extremes().roll_backs; }); },
      "(sessions,) uint64: ticks that the stability monitor rolled back.");
  vector.def_property_readonly(
      "positions_m",
      [](const SteppedVector& v) {
        return stacked(v, {-1, 3}, [](Core& c) { return positions(c.session->model(), stateOf(c)); });
      },
      "(sessions, slots, 3) float32 [m]: positions, NaN in empty slots. A copy.");
  vector.def_property_readonly(
      "displacement_m",
      [](const SteppedVector& v) {
        return stacked(v, {-1, 3}, [](Core& c) { return threes(stateOf(c).displacement_m); });
      },
      "(sessions, slots, 3) float32 [m]: displacements from rest. A copy.");
  vector.def_property_readonly(
      "velocity_m_per_s",
      [](const SteppedVector& v) {
        return stacked(v, {-1, 3}, [](Core& c) { return threes(stateOf(c).velocity_m_per_s); });
      },
      "(sessions, slots, 3) float32 [m/s]: velocities. A copy.");
}

}  // namespace

void bindVector(py::module_& module) {
  VectorClass vector(module, "VectorSession",
                     "Sessions of one scene that one call steps side by side on the CPU; vector[i] is one of them. "
                     "Arrays have the sessions as leading axis.");
  vector.def(py::init([](const SceneSource& scene, int64_t sessions, int threads) {
               if (sessions < 1 || sessions > kMostSessions)
                 throw py::value_error("sessions: must be 1 .. " + std::to_string(kMostSessions) + "; found " +
                                       std::to_string(sessions));
               if (threads < 0 || threads > kMostVectorThreads)
                 throw py::value_error("threads: must be 0 .. " + std::to_string(kMostVectorThreads) + "; found " +
                                       std::to_string(threads));
               return std::make_unique<SteppedVector>(scene, static_cast<size_t>(sessions), threads);
             }),
             py::arg("scene"), py::arg("sessions"), py::arg("threads") = 0,
             "threads: number for all sessions together, 0: one per processor; it does not change results.");
  bindVectorSteps(vector);
  bindVectorArrays(vector);
}

}  // namespace viscera::python
