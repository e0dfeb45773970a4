// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <memory>

#include "bench/harness/mapped_body.h"
#include "bench/harness/rate.h"
#include "bench/suites/egve/egve_parts.h"
#include "gpu/gl.h"
#include "model/shape/organ/phantom.h"
#include "render/renderer.h"
#include "viscera/model/shape/solid.h"

namespace viscera::bench {

namespace {

constexpr double kDearest = 1.3;  // limit, from EGVE 3.4: 6.67 ms over 5.26 ms
constexpr double kPaperConstantMs = 5.26, kPaperInterpolatedMs = 6.67;
constexpr int kMapsPerTick = 4;  // on the GPU, where each tick waits once for the queue

/// A mesh and its lattice.
struct Subject {
  std::string name;
  Solid solid;
  TriangleMesh mesh;
  bool is_papers = false;  ///< whether it has the size of EGVE's timings
};

Deformation swaying(double size_m) {
  return [size_m](const Vector3d& x) {
    return Vector3d(x + 0.05 * size_m * Vector3d(std::sin(3 * x.y() / size_m), std::sin(3 * x.z() / size_m), 0.3));
  };
}

/// Returns the spacing at which a size that falls with a power of it has a given value.
/// @param sizeAt  returns the size at a spacing
double spacingFor(double start_m, double wanted, double power, const std::function<double(double)>& sizeAt) {
  double spacing_m = start_m;
  for (int i = 0; i < 4; ++i) spacing_m *= std::pow(sizeAt(spacing_m) / wanted, 1 / power);
  return spacing_m;
}

/// Returns the built-in heart with partially filled cells, the default of scenes.
Subject heart(bool is_short) {
  const Phantom p = heartPhantom(0.1, 1);
  const double nodes = is_short ? 2000 : 20000, faces = is_short ? 5000 : 50000;
  const auto solidAt = [&](double h) { return voxeliseByMoments(p.field, p.part_names, p.min_m, p.max_m, h); };
  const auto meshAt = [&](double h) { return extractSkin(p.field, p.part_names, p.min_m, p.max_m, h); };
  const double node_spacing_m = spacingFor(is_short ? 0.006 : 0.003, nodes, 3, [&](double h) {
    return static_cast<double>(buildLattice(solidAt(h), Weights::kCell).active_slots.size());
  });
  const double skin_spacing_m = spacingFor(is_short ? 0.004 : 0.002, faces, 2, [&](double h) {
    return static_cast<double>(refine(meshAt(h), node_spacing_m).triangles.size());
  });
  return {"heart", solidAt(node_spacing_m), meshAt(skin_spacing_m), !is_short};
}

/// Returns a lumpy object of about 10,000 faces on 18 nodes, in place of EGVE's dragon.
Subject dragon() {
  Subject out{"18 nodes", {}, {}, false};
  out.solid.spacing_m = 0.02;
  out.solid.cells = {2, 2, 1};
  out.solid.labels.assign(4, 1);
  out.solid.part_names = {"dragon"};
  out.mesh = closedMesh(72, 70, [](const Vector3d& d) {
    const double lumps = 0.8 + 0.15 * std::sin(7 * d.x() + 1) * std::cos(9 * d.y()) + 0.05 * std::sin(25 * d.z());
    return Vector3d(Vector3d(0.02, 0.02, 0.01) + lumps * Vector3d(0.025, 0.025, 0.015).cwiseProduct(d));
  });
  return out;
}

double sizeOf(const Subject& subject) {
  return subject.solid.spacing_m * subject.solid.cells.maxCoeff();
}

Candidate onHost(const Subject& subject, const std::shared_ptr<Model>& model) {
  const auto surface = std::make_shared<HostSurface>(*model);
  const auto mesh = std::make_shared<VisibleMesh>();
  const auto state =
      std::make_shared<StateSnapshot>(movedState(*model, surface->shownBricks(), swaying(sizeOf(subject))));
  return {"cpu", 1, [=] {
            surface->show(*state, *mesh);
            return 1.0;
          }};
}

/// A surface on the GPU with an oscillating body, and a camera with all of it in view.
struct Drawn {
  std::shared_ptr<Surface> surface;
  std::shared_ptr<StateMirror> mirror;
  std::shared_ptr<Renderer> renderer;

  Drawn(const Subject& subject, const Model& model)
      : surface(std::make_shared<Surface>(model)), mirror(std::make_shared<StateMirror>(model)) {
    mirror->upload(movedState(model, mirror->shownBricks(), swaying(sizeOf(subject))));
    CameraConfig camera;
    camera.target_m = subject.solid.origin_m + 0.5 * subject.solid.spacing_m * subject.solid.cells.cast<double>();
    camera.position_m = camera.target_m - 2.2 * sizeOf(subject) * Vector3d::UnitY();
    camera.vertical_fov_deg = 30;
    renderer = std::make_shared<Renderer>(std::vector<CameraConfig>{camera}, std::vector<StylusConfig>{});
  }
  void map() const {
    StateView view = mirror->view();
    view.stale_bricks = 0;  // maps everything each time
    surface->follow(view);
  }
};

Candidate onGpu(const Drawn& drawn) {
  return {"gpu", 1, [=] {
            for (int i = 0; i < kMapsPerTick; ++i) drawn.map();
            glFinish();
            return static_cast<double>(kMapsPerTick);
          }};
}
Candidate pictureOf(const Drawn& drawn) {
  return {"picture", 1, [=] {
            drawn.map();
            drawn.renderer->draw(0, *drawn.surface, {});
            glFinish();
            return 1.0;
          }};
}

/// Times of each mapping in turn [ms]; on the GPU also of an image.
struct Times {
  std::vector<double> map_ms, picture_ms;
};

Times measureTimes(Report& report, const Subject& subject, Backend backend,
                   const std::vector<std::shared_ptr<Model>>& models) {
  std::vector<Candidate> candidates;
  for (const auto& model : models) {
    if (backend == Backend::kCpu) {
      candidates.push_back(onHost(subject, model));
      continue;
    }
    const Drawn drawn(subject, *model);
    candidates.push_back(onGpu(drawn));
    candidates.push_back(pictureOf(drawn));
  }
  const std::vector<Rate> rates = measureRates(candidates, report.isShort() ? 0.02 : 0.2, report.isShort() ? 3 : 9);
  Times out;
  for (size_t i = 0; i < candidates.size(); ++i)
    (candidates[i].name == "picture" ? out.picture_ms : out.map_ms).push_back(1e3 / rates[i].substeps_per_s);
  return out;
}

size_t numberOf(Mapping mapping) {
  const auto& all = allMappings();
  return static_cast<size_t>(std::find(all.begin(), all.end(), mapping) - all.begin());
}

Cell paperMs(const Subject& subject, Mapping mapping) {
  if (subject.is_papers && mapping == Mapping::kConstant) return kPaperConstantMs;
  if (subject.is_papers && mapping == Mapping::kInterpolated) return kPaperInterpolatedMs;
  return "";
}

void measureSubject(Report& report, const Subject& subject, Backend backend, Table& table) {
  report.stage("mappings of " + subject.name + ", " + nameOf(backend));
  std::vector<std::shared_ptr<Model>> models;
  for (const Mapping mapping : allMappings())
    models.push_back(std::make_shared<Model>(mappedModel(subject.solid, subject.mesh, mapping)));
  const Times times = measureTimes(report, subject, backend, models);
  const size_t constant = numberOf(Mapping::kConstant), interpolated = numberOf(Mapping::kInterpolated);
  const bool drawn = !times.picture_ms.empty();
  for (size_t i = 0; i < models.size(); ++i) {
    const auto over = [&](const std::vector<double>& ms) { return ms[i] / ms[constant]; };
    table.add({subject.name, static_cast<double>(models[i]->bodies[0].skin.mesh.triangles.size()),
               static_cast<double>(models[i]->activeNodes()), nameOf(backend), nameOf(allMappings()[i]),
               100 * shareAsAsked(*models[i]), times.map_ms[i], over(times.map_ms),
               drawn ? Cell(times.picture_ms[i]) : Cell(""), drawn ? Cell(over(times.picture_ms)) : Cell(""),
               paperMs(subject, allMappings()[i])});
  }
  if (report.isShort()) return;
  const std::vector<double>& judged = drawn ? times.picture_ms : times.map_ms;
  report.checkAtMost("interpolated over constant, time of " + std::string(drawn ? "a picture" : "the mapping") + ", " +
                         subject.name + ", " + nameOf(backend),
                     judged[interpolated] / judged[constant], kDearest);
}

}  // namespace

void measureMappingTimes(Report& report) {
  Table table(
      "time of a mapping: approximate normals of nodes, positions and normals of vertices; on the GPU also with a "
      "picture "
      "(640 x 480)",
      {{"body"},
       {"faces", "", 8},
       {"nodes", "", 8},
       {"backend"},
       {"mapping"},
       {"vertices that have it", "%", 3},
       {"time", "ms", 3},
       {"over constant", "", 3},
       {"with a picture", "ms", 3},
       {"over constant", "", 3},
       {"EGVE, with a picture", "ms", 3}});
  for (const Subject& subject : {heart(report.isShort()), dragon()}) {
    for (const Backend backend : report.backends()) measureSubject(report, subject, backend, table);
  }
  report.add(table, "times");
}

}  // namespace viscera::bench
