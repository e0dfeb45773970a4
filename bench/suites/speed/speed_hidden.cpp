// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <memory>

#include "bench/harness/mapped_body.h"
#include "bench/harness/rate.h"
#include "bench/suites/speed/speed_parts.h"
#include "session/inline_view.h"
#include "surface/follow/state_mirror.h"
#include "surface/skin_boxes.h"
#include "surface/skins/joined_skins.h"

namespace viscera::bench {

namespace {

constexpr double kSpeedHiddenDearer = 1.05;  // all in view: an image with culling relative to one without
constexpr double kSway = 0.02;  // relative to the body's size: every vertex is mapped again for every image

/// Returns a heart, and cameras that look at it and past it.
Scene hiddenScene(bool short_form, bool draw_hidden) {
  Scene scene = pigHeartScene(short_form ? 1500 : 10000, 0.2);
  scene.bodies[0].skin_spacing_m = short_form ? 0.004 : 0.0015;
  const CameraConfig all = scene.cameras[0];
  const Vector3d sight = all.target_m - all.position_m, right = sight.cross(all.up).normalized();
  scene.cameras.clear();
  const auto add = [&](const std::string& name, double aside_m) {
    CameraConfig camera = all;
    camera.name = name;
    camera.target_m += aside_m * right;
    camera.position_m += aside_m * right;
    camera.draw_hidden = draw_hidden;
    scene.cameras.push_back(camera);
  };
  add("all of it", 0);
  add("nothing of it", 0.3);
  return scene;
}

/// A view of tissue on the host that moves between images.
class Viewed {
 public:
  Viewed(bool short_form, bool draw_hidden)
      : scene_(hiddenScene(short_form, draw_hidden)),
        model_(buildModel(scene_)),
        view_(model_, scene_),
        mirror_(model_) {
    for (const double side : {-1.0, 1.0}) {
      const auto moved = [side](const Vector3d& x) {
        return Vector3d(x + side * kSway * 0.1 * Vector3d(std::sin(30 * x.y()), std::sin(30 * x.z()), 0.3));
      };
      states_.push_back(movedState(model_, mirror_.shownBricks(), moved));
    }
  }
  const Scene& scene() const { return scene_; }
  const Model& model() const { return model_; }
  Candidate picture(size_t camera) {
    return {"", 1, [this, camera] {
              mirror_.upload(states_[++ticks_ % 2]);
              RenderRequest request;
              request.tick = ticks_;
              request.outputs.cameras.assign(scene_.cameras.size(), false);
              request.outputs.cameras[camera] = true;
              Pictures out;
              view_.capture(mirror_.view(), request, out, mirror_.displacements());
              view_.collect(out, true);
              return 1.0;
            }};
  }
  /// Returns the cost of computing all bounding boxes.
  Candidate boxes(const SkinBoxes& boxes) {
    return {"", 1, [this, &boxes] { return boxes.place(mirror_.displacements()).empty() ? 0.0 : 1.0; }};
  }

 private:
  Scene scene_;
  Model model_;
  InlineView view_;
  StateMirror mirror_;
  std::vector<StateSnapshot> states_;
  uint64_t ticks_ = 0;
};

}  // namespace

void measureHidden(Report& report) {
  report.stage("what no camera sees");
  Viewed seen(report.isShort(), false), all(report.isShort(), true);
  const double seconds = report.isShort() ? 0.02 : 0.3;
  const int rounds = report.isShort() ? 3 : 9;
  const SkinBoxes boxes(seen.model(), joinSkins(seen.model()).bindings);
  const double boxes_ms = 1e3 / measureRates({seen.boxes(boxes)}, seconds, rounds)[0].substeps_per_s;
  Table table("pictures (640 x 480) of a heart of " + std::to_string(seen.model().skinTriangles()) + " faces on " +
                  std::to_string(seen.model().activeNodes()) +
                  " nodes, all mapped again; hidden parts drawn, and skipped",
              {{"in the picture"},
               {"drawn", "ms", 3},
               {"left out", "ms", 3},
               {"left out over drawn", "", 3},
               {"boxes", "ms", 2},
               {"spread", "", 2}});
  for (size_t c = 0; c < seen.scene().cameras.size(); ++c) {
    const std::vector<Rate> rates = measureRates({all.picture(c), seen.picture(c)}, seconds, rounds);
    const double drawn_ms = 1e3 / rates[0].substeps_per_s, left_out_ms = 1e3 / rates[1].substeps_per_s;
    table.add({seen.scene().cameras[c].name, drawn_ms, left_out_ms, left_out_ms / drawn_ms, boxes_ms,
               std::max(rates[0].spread, rates[1].spread)});
    if (c == 0 && !report.isShort())
      report.checkAtMost("hidden: a picture with everything in view, hidden parts skipped over drawn",
                         left_out_ms / drawn_ms, kSpeedHiddenDearer);
  }
  report.add(table, "hidden");
}

}  // namespace viscera::bench
