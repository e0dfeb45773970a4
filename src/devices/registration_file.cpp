// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "devices/registration_file.h"

#include <array>

#include "math/out_file.h"
#include "model/scene/yaml/yaml_reader.h"

namespace viscera {
namespace {

constexpr Range kPosition_m{-100, 100};
constexpr double kMostPoints = 1000;
constexpr int kFileDigits = 9;           ///< YAML::Emitter would write numbers in the program's locale
constexpr double kUnitTolerance = 1e-3;  ///< tolerance of a quaternion's norm: the user may leave out digits

struct FileTip {
  Vector3d position_m = Vector3d::Zero();
};
struct FileBase {
  int line = 0;
  Vector3d position_m = Vector3d::Zero();
  std::array<double, 4> orientation_xyzw{0, 0, 0, 1};
};
struct FileRegistration {
  FileTip tip;
  FileBase base;
  bool has_tip = false, has_base = false;
  double residual_mm = 0;
};
struct FilePoint {
  std::string name;
  Vector3d position_m = Vector3d::Zero();
};
struct FilePoints {
  std::vector<FilePoint> points;
};

void visitFields(YamlReader& v, FileTip& c) {
  v.vector("position_m", c.position_m, kPosition_m, "m", "position of the tip in the frame of the device's pose");
}

void visitFields(YamlReader& v, FileBase& c) {
  c.line = v.line();
  v.vector("position_m", c.position_m, kPosition_m, "m", "position of the device's base in the tissue frame");
  v.numbers("orientation_xyzw", c.orientation_xyzw, {-1, 1}, "");
}

void visitFields(YamlReader& v, FileRegistration& c) {
  c.has_tip = v.has("tip");
  c.has_base = v.has("base");
  v.group("tip", c.tip, "");
  v.group("base", c.base, "");
  v.number("residual_mm", c.residual_mm, {0, 1e6}, "mm", "residual of the last tip or base that was found");
}

void visitFields(YamlReader& v, FilePoint& c) {
  v.text("name", c.name, "name of the point");
  v.vector("position_m", c.position_m, kPosition_m, "m", "position of the point in the tissue frame");
}

void visitFields(YamlReader& v, FilePoints& c) {
  v.list("points", c.points, kMostPoints, "points, in the order in which they are touched");
}

template <class File>
File read(const std::string& yaml, const std::string& name) {
  File file;
  try {
    const YamlSource source{name, {}};
    YamlReader::readMap(YAML::Load(yaml), "", source, file);
  } catch (const YAML::Exception& e) {
    throw RegistrationError(yamlFault(name, e, yaml));
  } catch (const SceneError& e) {
    throw RegistrationError(e.what());
  }
  return file;
}

std::string textOfFile(const std::string& path, const std::string& what) {
  try {
    return textOf(path, what);
  } catch (const SceneError& e) {
    throw RegistrationError(e.what());
  }
}

YAML::Emitter& operator<<(YAML::Emitter& out, const Vector3d& v) {
  out << YAML::Flow << YAML::BeginSeq;
  for (int axis = 0; axis < 3; ++axis) out << numberText(v[axis], kFileDigits);
  return out << YAML::EndSeq;
}

}  // namespace

std::string registrationYaml(const RegistrationFile& registration) {
  YAML::Emitter out;
  out << YAML::BeginMap;
  if (registration.tip_m)
    out << YAML::Key << "tip" << YAML::Value << YAML::Flow << YAML::BeginMap << YAML::Key << "position_m" << YAML::Value
        << *registration.tip_m << YAML::EndMap;
  if (registration.base) {
    const Quaterniond& q = registration.base->orientation;
    out << YAML::Key << "base" << YAML::Value << YAML::Flow << YAML::BeginMap << YAML::Key << "position_m"
        << YAML::Value << registration.base->position_m << YAML::Key << "orientation_xyzw" << YAML::Value << YAML::Flow
        << YAML::BeginSeq;
    for (const double value : {q.x(), q.y(), q.z(), q.w()}) out << numberText(value, kFileDigits);
    out << YAML::EndSeq << YAML::EndMap;
  }
  out << YAML::Key << "residual_mm" << YAML::Value << numberText(1e3 * registration.residual_m, kFileDigits)
      << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

void saveRegistration(const RegistrationFile& registration, const std::string& path) {
  try {
    writeFile(path, FileKind::kRegistration, registrationYaml(registration));
  } catch (const RegistrationError&) {
    throw;
  } catch (const Error& error) {
    throw RegistrationError(error.what());
  }
}

RegistrationFile parseRegistration(const std::string& yaml, const std::string& name) {
  const auto file = read<FileRegistration>(yaml, name);
  RegistrationFile out;
  out.residual_m = 1e-3 * file.residual_mm;
  if (file.has_tip) out.tip_m = file.tip.position_m;
  if (file.has_base) {
    const auto& q = file.base.orientation_xyzw;
    const Quaterniond turn(q[3], q[0], q[1], q[2]);
    if (!(std::abs(turn.norm() - 1) <= kUnitTolerance))
      throw RegistrationError(name + ":" + std::to_string(file.base.line) +
                              ": 'base.orientation_xyzw' must be a quaternion of length 1; its length is " +
                              numberText(turn.norm()));
    out.base = Pose{file.base.position_m, turn.normalized()};
  }
  return out;
}

RegistrationFile loadRegistration(const std::string& path) {
  return parseRegistration(textOfFile(path, "registration"), path);
}

std::vector<KnownPoint> parseKnownPoints(const std::string& yaml, const std::string& name) {
  std::vector<KnownPoint> points;
  for (const FilePoint& point : read<FilePoints>(yaml, name).points)
    points.push_back(
        {point.name.empty() ? "point " + std::to_string(points.size() + 1) : point.name, point.position_m});
  if (points.size() < kLeastPoints)
    throw RegistrationError(name + ": 'points' must hold " + std::to_string(kLeastPoints) + " points at least; found " +
                            std::to_string(points.size()));
  return points;
}

std::vector<KnownPoint> loadKnownPoints(const std::string& path) {
  return parseKnownPoints(textOfFile(path, "points"), path);
}

}  // namespace viscera
