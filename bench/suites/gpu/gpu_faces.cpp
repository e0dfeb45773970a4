// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <optional>

#include "bench/harness/machine/machine.h"
#include "bench/harness/mapped_body.h"
#include "bench/harness/rate.h"
#include "bench/suites/gpu/gpu_parts.h"
#include "gpu/fence.h"
#include "model/scene/host_memory.h"
#include "render/renderer.h"
#include "viscera/gpu/context.h"
#include "viscera/math/error.h"

namespace viscera::bench {

namespace {

constexpr double kRadius_m = 0.05;
constexpr size_t kSoftwareUpTo = 1000000;  // number of faces; a software rasteriser takes seconds for more
/// Host memory per face until its mesh is in buffers [bytes]: the peak of memory at ten million faces, divided by their
/// number.
constexpr double kBytesPerFace = 350;
// Per vertex: its binding in; position and normal out. Per drawn face: its indices, and half a vertex with position,
// normal, colour and rest position.
constexpr double kMappedBytes = 96 + 12 + 4, kDrawnBytes = 12 + 0.5 * (12 + 4 + 4 + 16);

/// Returns a ball of cells. @param cells  along its diameter
Solid ballOf(int cells) {
  Solid out;
  out.spacing_m = 2 * kRadius_m / cells;
  out.cells = {cells, cells, cells};
  out.origin_m = Vector3d::Constant(-kRadius_m);
  out.part_names = {"ball"};
  for (int z = 0; z < cells; ++z) {
    for (int y = 0; y < cells; ++y) {
      for (int x = 0; x < cells; ++x) {
        const Vector3d middle = out.origin_m + out.spacing_m * Vector3d(x + 0.5, y + 0.5, z + 0.5);
        out.labels.push_back(middle.norm() < kRadius_m ? 1 : 0);
      }
    }
  }
  return out;
}

/// Returns a sphere with dents. @param faces  approximate number
TriangleMesh skinOf(size_t faces) {
  const int around = 2 * static_cast<int>(std::sqrt(0.25 * static_cast<double>(faces)));
  return closedMesh(around, around / 2 + 1, [](const Vector3d& d) {
    const double lumps = 0.97 + 0.03 * std::sin(9 * d.x()) * std::cos(8 * d.y()) * std::sin(7 * d.z() + 1);
    return Vector3d(kRadius_m * lumps * d);
  });
}

Vector3d swaying(const Vector3d& x_m) {
  return x_m + 0.1 * kRadius_m * Vector3d(std::sin(30 * x_m.y()), std::sin(30 * x_m.z()), 0.3);
}

/// Returns why a mesh is not measured here; empty if it is.
std::string reasonAgainst(size_t faces, const gpu::Context& context) {
  if (faces > kSoftwareUpTo && context.isSoftware()) return "the renderer is software, which would take seconds";
  const double needs = kBytesPerFace * static_cast<double>(faces), has = availableBytes();
  if (needs > has)
    return "they need " + Cell(1e-9 * needs).text(2) + " GB of the host's memory, of which " +
           Cell(1e-9 * has).text(2) + " GB are free";
  return {};
}

struct Times {
  double vertices, map_s, draw_s;
};

/// Measures a mesh. @throws GpuError  out of memory
Times measureSkin(Report& report, size_t faces, int cells) {
  const Model model = mappedModel(ballOf(cells), skinOf(faces), Mapping::kAuto);
  Surface surface(model);
  StateMirror mirror(model);
  mirror.upload(movedState(model, mirror.shownBricks(), swaying));
  CameraConfig camera;
  camera.position_m = Vector3d(0, -4.5 * kRadius_m, 0);
  camera.vertical_fov_deg = 30;
  Renderer renderer({camera}, {});
  const auto map = [&] {
    StateView view = mirror.view();
    view.stale_bricks = 0;  // maps everything each time
    surface.follow(view);
  };
  map();
  const std::vector<Rate> rates = measureRates({{"map", 1,
                                                 [&] {
                                                   map();
                                                   gpu::awaitGpu("a measurement");
                                                   return 1.0;
                                                 }},
                                                {"draw", 1,
                                                 [&] {
                                                   renderer.draw(0, surface, {});
                                                   gpu::awaitGpu("a measurement");
                                                   return 1.0;
                                                 }}},
                                               report.isShort() ? 0.05 : 0.3);
  gpu::checkErrors("mapping and drawing");
  return {static_cast<double>(surface.vertices()), 1 / rates[0].substeps_per_s, 1 / rates[1].substeps_per_s};
}

}  // namespace

void measureFaces(Report& report) {
  const double copy = gpuCopyRate(report.isShort() ? 32 : 256);
  const CameraConfig camera;
  const int cells = report.isShort() ? 16 : 42;  // about 40,000 nodes
  Table table("skin of a ball of " + std::to_string(cells) + " cells across, all of it mapped, and drawn at " +
                  std::to_string(camera.width_px) + " x " + std::to_string(camera.height_px),
              {{"faces", "", 8},
               {"mapping", "ms", 3},
               {"drawing", "ms", 3},
               {"mapping, of copy rate", "%", 3},
               {"drawing, of copy rate", "%", 3},
               {"left out, as"}});
  Plot plot{"Skin on " + report.context()->renderer(), "faces", "ms", true, true,
            {{"mapping", {}, {}}, {"drawing", {}, {}}}};
  for (const size_t faces : {size_t{100000}, size_t{1000000}, size_t{10000000}}) {
    report.stage("skin of " + std::to_string(faces) + " faces");
    const double count = static_cast<double>(faces);
    std::string against = reasonAgainst(faces, *report.context());
    if (against.empty() && report.isShort() && faces > 100000) against = "the short form measures only one size";
    std::optional<Times> times;
    if (against.empty()) {
      try {
        times = measureSkin(report, faces, cells);
      } catch (const GpuError& error) {
        against = error.what();
      }
    }
    if (!times) {
      table.add({count, "", "", "", "", against});
      continue;
    }
    table.add({count, 1e3 * times->map_s, 1e3 * times->draw_s,
               100 * kMappedBytes * times->vertices / times->map_s / copy,
               100 * kDrawnBytes * count / times->draw_s / copy, ""});
    for (Series& series : plot.series) series.x.push_back(count);
    plot.series[0].y.push_back(1e3 * times->map_s);
    plot.series[1].y.push_back(1e3 * times->draw_s);
  }
  report.note(
      "Bytes are the data that must be moved once: a binding in, a position and a normal out; indices and vertices "
      "in.\n");
  report.add(table, "faces");
  if (plot.series[0].x.size() > 1) report.add(plot, "faces");
}

}  // namespace viscera::bench
