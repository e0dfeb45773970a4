// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/validate/validate_trials.h"

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "bench/harness/specimens/clamp.h"
#include "bench/suites/validate/measured_curves.h"
#include "viscera/math/error.h"
#include "viscera/session/session.h"

namespace viscera::bench {

namespace {

constexpr double kCylinderWidth_m = 0.05, kCylinderHeight_m = 0.03;
constexpr int kCylinderSides = 96;
constexpr double kYoung_pa = 20000, kDensity_kg_per_m3 = 1000;
constexpr double kTrialTick_hz = 120;
constexpr double kPlateSpeed_m_per_s = 0.006;  // a five-hundredth of the speed of sound: inertia is negligible
constexpr double kSinkSpeed = 0.4;             // of the sphere, in radii per second
constexpr double kFromAbove = 0.1;             // relative to the radius: a tip that appears in tissue feels nothing
constexpr double kSphereSpacing_m = 0.004;

/// A temporary mesh file, removed with this object.
class CylinderFile {
 public:
  /// Writes a polygon with the area of the circle.
  CylinderFile()
      : path_(std::filesystem::temp_directory_path() / ("viscera-cylinder-" + std::to_string(getpid()) + ".obj")) {
    const double step = 2 * M_PI / kCylinderSides, radius_m = kCylinderWidth_m / 2 * std::sqrt(step / std::sin(step));
    std::ofstream out(path_);
    for (int i = 0; i < kCylinderSides; ++i) {
      for (const double z : {-kCylinderHeight_m / 2, kCylinderHeight_m / 2})
        out << "v " << radius_m * std::cos(i * step) << ' ' << radius_m * std::sin(i * step) << ' ' << z << '\n';
    }
    out << "v 0 0 " << -kCylinderHeight_m / 2 << "\nv 0 0 " << kCylinderHeight_m / 2 << '\n';
    for (int i = 0; i < kCylinderSides; ++i) {
      const int low = 2 * i + 1, next = 2 * ((i + 1) % kCylinderSides) + 1, middle = 2 * kCylinderSides + 1;
      out << "f " << low << ' ' << next << ' ' << next + 1 << "\nf " << low << ' ' << next + 1 << ' ' << low + 1
          << "\nf " << middle << ' ' << next << ' ' << low << "\nf " << middle + 1 << ' ' << low + 1 << ' ' << next + 1
          << '\n';
    }
    if (!out.flush()) throw Error(path_.string() + ": cannot be written");
  }
  ~CylinderFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  CylinderFile(const CylinderFile&) = delete;
  CylinderFile& operator=(const CylinderFile&) = delete;
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

BodyConfig softBody(double poisson_ratio, double spacing_m) {
  BodyConfig body;
  body.spacing_m = spacing_m;
  body.material.young_modulus_pa = kYoung_pa;
  body.material.poisson_ratio = poisson_ratio;
  body.material.density_kg_per_m3 = kDensity_kg_per_m3;
  return body;
}

Scene quietScene(const BodyConfig& body) {
  Scene scene;
  scene.environment.gravity_m_per_s2 = Vector3d::Zero();
  scene.solver.tick_hz = kTrialTick_hz;
  scene.solver.backend = Backend::kCpu;
  scene.bodies = {body};
  return scene;
}

}  // namespace

double Compression::at(double at_strain) const {
  return interpolated(strain, stress_over_e, at_strain);
}

Compression compressedCylinder(double poisson_ratio, double spacing_m, double most_strain) {
  const CylinderFile cylinder;
  BodyConfig body = softBody(poisson_ratio, spacing_m);
  body.source = TissueSource::kMesh;
  body.mesh_file = cylinder.path();
  Scene scene = quietScene(body);
  ObstacleConfig plate;
  plate.friction = 0;
  plate.name = "below";
  plate.position_m.z() = -kCylinderHeight_m / 2;
  scene.obstacles.push_back(plate);
  plate.name = "above";
  plate.position_m.z() = kCylinderHeight_m / 2;
  plate.rotation_deg.x() = 180;
  plate.velocity_m_per_s.z() = -kPlateSpeed_m_per_s;
  scene.obstacles.push_back(plate);
  Session session(scene);
  const double area_m2 = M_PI / 4 * kCylinderWidth_m * kCylinderWidth_m;
  Compression out{{0}, {0}};
  while (out.strain.back() < most_strain) {
    const Frame frame = session.step({}, {});
    const double travel_m = kPlateSpeed_m_per_s * static_cast<double>(session.tick()) * session.tick_s();
    const double force_n = (frame.obstacle_forces[1].force_n.z() - frame.obstacle_forces[0].force_n.z()) / 2;
    // Forces are means over a tick, and this is its middle.
    out.strain.push_back((travel_m - kPlateSpeed_m_per_s * session.tick_s() / 2) / kCylinderHeight_m);
    out.stress_over_e.push_back(force_n / area_m2 / kYoung_pa);
  }
  return out;
}

SpherePress pressedSphere(double poisson_ratio, int radius, const std::vector<double>& depths) {
  const double radius_m = radius * kSphereSpacing_m;
  BodyConfig body = softBody(poisson_ratio, kSphereSpacing_m);
  body.source = TissueSource::kBox;
  body.box_size_m = radius_m * Vector3d(10, 10, 5);
  const double top_m = body.box_size_m.z() / 2;
  body.fixed.push_back(clampBehind(Vector3d(0, 0, -top_m), Vector3d::UnitZ()));
  Scene scene = quietScene(body);
  StylusConfig stylus;
  stylus.probe.radius_m = radius_m;
  scene.styluses = {stylus};
  Session session(scene);
  SpherePress out;
  StylusSamples samples;
  samples[0].valid = true;
  double before_m = -kFromAbove * radius_m, force_n = 0;
  for (const double wanted : depths) {
    while (before_m < wanted * radius_m) {
      const double depth_m = before_m + kSinkSpeed * radius_m * session.tick_s();
      samples[0].pose.position_m = Vector3d(0, 0, top_m + radius_m - depth_m);
      samples[0].received = std::chrono::steady_clock::now();
      force_n = session.step(samples, {}).contacts[0].reaction.force_n.z();
      before_m = depth_m;
    }
    const double middle_m = before_m - kSinkSpeed * radius_m * session.tick_s() / 2;
    out.depth_over_r.push_back(middle_m / radius_m);
    out.over_hertz.push_back(force_n / (4.0 / 3 * kYoung_pa / (1 - poisson_ratio * poisson_ratio) *
                                        std::sqrt(radius_m) * std::pow(middle_m, 1.5)));
  }
  return out;
}

}  // namespace viscera::bench
