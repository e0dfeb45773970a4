// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "python/stylus_binding.h"

#include <cmath>
#include <optional>
#include <string>

#include <pybind11/stl.h>

#include "math/number_text.h"
#include "python/arrays.h"

namespace viscera::python {

namespace {

constexpr double kFarthest_m = 1000;      // distance of a tip from the origin, limited by the resolution of float32
constexpr double kUnitWithin = 1e-9;      // tolerance of a unit quaternion, which is kept as it is, so that poses from
                                          // files keep their bits
constexpr double kNearUnitWithin = 1e-2;  // tolerance of a rounded quaternion, which is normalised; others are refused

/// Returns an array of `count` numbers. @throws TypeError, ValueError
Given<double> numbersOf(const py::object& given, py::ssize_t count, const char* what) {
  const std::string wanted = std::string(what) + ": must be " + std::to_string(count) + " numbers in one row";
  Given<double> out;
  try {
    out = Given<double>(given, "float64");
  } catch (const py::error_already_set&) {
    throw py::type_error(wanted);
  }
  if (out.ndim() != 1 || out.shape(0) != count) throw py::value_error(wanted);
  return out;
}

void requireWithin(const double* values, int count, const char* what, double most) {
  for (int i = 0; i < count; ++i) {
    if (!(std::abs(values[i]) <= most))
      throw py::value_error(std::string(what) + ": must be numbers -" + numberText(most) + " .. " + numberText(most) +
                            "; found " + numberText(values[i]));
  }
}

StylusSample makeSample(const py::object& position_m, const py::object& quaternion, bool button1, bool button2,
                        const std::optional<double>& jaw_rad) {
  const Given<double> at = numbersOf(position_m, 3, "position_m");
  StylusSample out = sampleOf(at.data(), numbersOf(quaternion, 4, "quaternion").data());
  out.button1 = button1;
  out.button2 = button2;
  if (!jaw_rad) return out;
  if (!(*jaw_rad >= 0 && *jaw_rad <= kWidestJaw_rad))
    throw py::value_error("jaw_rad: must be 0 .. " + numberText(kWidestJaw_rad) + "; found " + numberText(*jaw_rad));
  out.jaw_rad = static_cast<float>(*jaw_rad);
  return out;
}

/// Returns the Python expression of a stylus.
std::string stylusText(const StylusSample& sample) {
  const auto shown = [](double value) { return std::string(py::repr(py::float_(value))); };
  const Vector3d& at = sample.pose.position_m;
  const Quaterniond& q = sample.pose.orientation;
  std::string out = "viscera.Stylus([" + shown(at.x()) + ", " + shown(at.y()) + ", " + shown(at.z()) + "]";
  if (q.coeffs() != Quaterniond::Identity().coeffs())
    out += ", [" + shown(q.x()) + ", " + shown(q.y()) + ", " + shown(q.z()) + ", " + shown(q.w()) + "]";
  if (sample.button1) out += ", button1=True";
  if (sample.button2) out += ", button2=True";
  if (!(sample.jaw_rad < 0)) out += ", jaw_rad=" + shown(std::round(1e6 * sample.jaw_rad) / 1e6);
  return out + ")";
}

}  // namespace

StylusSample sampleOf(const double* position_m, const double* quaternion) {
  requireWithin(position_m, 3, "position_m", kFarthest_m);
  requireWithin(quaternion, 4, "quaternion", 1 + kNearUnitWithin);
  StylusSample out;
  out.valid = true;
  out.pose.position_m = {position_m[0], position_m[1], position_m[2]};
  out.pose.orientation = {quaternion[3], quaternion[0], quaternion[1], quaternion[2]};
  const double off = std::abs(out.pose.orientation.norm() - 1);
  if (!(off <= kNearUnitWithin)) throw py::value_error("quaternion: must be x, y, z, w with length 1, within 0.01");
  if (off > kUnitWithin) out.pose.orientation.normalize();
  return out;
}

void bindStylus(py::module_& module) {
  auto stylus = py::class_<StylusSample>(module, "Stylus",
                                         "State of a stylus: the pose of its tip in the tissue frame, and its "
                                         "buttons. The shaft points along -z.");
  stylus.def(py::init(&makeSample), py::arg("position_m"), py::arg("quaternion") = py::make_tuple(0, 0, 0, 1),
             py::arg("button1") = false, py::arg("button2") = false, py::arg("jaw_rad") = py::none(),
             "position_m: (3,) [m], -1000 .. 1000. quaternion: (4,) x, y, z, w of length 1. jaw_rad: opening "
             "of the tool's jaws [rad], 0 .. 3.1416; None: buttons close them.");
  stylus.def_property_readonly(
      "position_m",
      [](const StylusSample& s) {
        return arrayOf({s.pose.position_m.x(), s.pose.position_m.y(), s.pose.position_m.z()});
      },
      "(3,) float64 [m], tissue frame; a copy.");
  stylus.def_property_readonly(
      "quaternion",
      [](const StylusSample& s) {
        const Quaterniond& q = s.pose.orientation;
        return arrayOf({q.x(), q.y(), q.z(), q.w()});
      },
      "(4,) float64 x, y, z, w; a copy.");
  stylus.def_readonly("button1", &StylusSample::button1);
  stylus.def_readonly("button2", &StylusSample::button2);
  stylus.def_property_readonly(
      "jaw_rad",
      [](const StylusSample& s) { return s.jaw_rad < 0 ? std::optional<double>() : std::optional<double>(s.jaw_rad); },
      "Opening of the jaws [rad], or None.");
  stylus.def("__repr__", &stylusText);
}

StylusSamples samplesOf(const py::object& given, size_t styluses) {
  StylusSamples out{};
  if (given.is_none()) return out;
  const auto put = [&](size_t at, py::handle one) {
    if (at >= styluses)
      throw py::value_error("styluses: more than the scene has, which is " + std::to_string(styluses));
    if (!one.is_none()) out[at] = py::cast<const StylusSample&>(one);
  };
  try {
    if (py::isinstance<StylusSample>(given)) {
      put(0, given);
      return out;
    }
    if (!py::isinstance<py::sequence>(given) || py::isinstance<py::str>(given)) throw py::cast_error();
    size_t at = 0;
    for (const py::handle one : given) put(at++, one);
  } catch (const py::cast_error&) {
    throw py::type_error("styluses: must be None, a Stylus, or a list of these");
  }
  return out;
}

}  // namespace viscera::python
