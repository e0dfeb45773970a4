// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <iterator>
#include <memory>
#include <utility>

#include "bench/harness/rate.h"
#include "bench/harness/similarity.h"
#include "bench/harness/specimens/clamp.h"
#include "bench/harness/specimens/specimen.h"
#include "bench/suites/pace/performance_suites.h"
#include "gpu/stage_clock.h"
#include "session/inline_view.h"
#include "surface/follow/state_mirror.h"
#include "viscera/gpu/context.h"
#include "viscera/session/session.h"
#include "viscera/tools/strokes.h"

namespace viscera::bench {

namespace {

constexpr double kWanted_s = 0.06;  // time of an image on two idle cores without a GPU
constexpr double kAlike = 0.97;     // structural similarity to the reference
constexpr double kDent_s = 0.75;    // strokes: a probe moves in
constexpr double kFlap_s = 6;       // strokes: two cuts are made

/// Returns the scene `heart`, with visible tools.
Scene heartScene() {
  Scene scene = pigHeartScene(1000, 0.1);
  BodyConfig& heart = scene.bodies[0];
  heart = BodyConfig();
  heart.name = "heart";
  heart.source = TissueSource::kPhantom;
  heart.phantom_length_m = 0.1;
  heart.spacing_m = 0.005;
  heart.skin_spacing_m = 0.003;
  heart.fixed.push_back(clampAbove(0.03));
  for (StylusConfig& stylus : scene.styluses) {
    stylus.button1 = ToolMode::kGrab;
    stylus.button2 = ToolMode::kCut;
    stylus.cut.blade_length_m = 0.022;
  }
  scene.solver.backend = Backend::kCpu;
  return scene;
}

/// A probe dents the front, then a blade cuts along it twice while the other stylus holds the tissue.
constexpr const char* kStrokes = R"(
strokes:
  - stylus: left
    anchor: {from_m: [-0.002, -0.3, -0.015], towards_m: [-0.002, 0, -0.015]}
    keys:
      - {t_s: 0.0, position_m: [-0.03, 0, 0.04], rotation_deg: [0, 0, 0]}
      - {t_s: 0.4, position_m: [0, 0, 0.008], rotation_deg: [0, 0, 0]}
      - {t_s: 0.9, position_m: [0, 0, -0.008], rotation_deg: [0, 0, 0]}
      - {t_s: 1.4, position_m: [0, 0, 0.015], rotation_deg: [0, 0, 0]}
      - {t_s: 1.7, position_m: [-0.04, 0, 0.03], rotation_deg: [0, -30, 0]}
      - {t_s: 4.0, position_m: [-0.011, 0, 0.012], rotation_deg: [0, -30, 0]}
      - {t_s: 4.2, position_m: [-0.011, 0, -0.007], rotation_deg: [0, -30, 0], button1: true}
      - {t_s: 5.5, position_m: [-0.025, 0, 0.01], rotation_deg: [0, -30, 0], button1: true}
      - {t_s: 7.0, position_m: [-0.025, 0, 0.01], rotation_deg: [0, -30, 0], button1: true}
  - stylus: right
    anchor: {from_m: [-0.002, -0.3, -0.015], towards_m: [-0.002, 0, -0.015]}
    keys:
      - {t_s: 0.0, position_m: [0.04, 0.03, 0.04], rotation_deg: [0, 0, 0]}
      - {t_s: 1.5, position_m: [0, 0.02, 0.014], rotation_deg: [0, 0, 0], button2: true}
      - {t_s: 1.7, position_m: [0, 0.02, -0.018], rotation_deg: [0, 0, 0], button2: true}
      - {t_s: 2.2, position_m: [0, -0.024, -0.018], rotation_deg: [0, 0, 0], button2: true}
      - {t_s: 2.6, position_m: [0, 0.02, -0.018], rotation_deg: [0, 0, 0], button2: true}
      - {t_s: 2.7, position_m: [0, 0.02, 0.014], rotation_deg: [0, 0, 0], button2: false}
      - {t_s: 3.0, position_m: [-0.02, 0.018, 0.014], rotation_deg: [0, 0, 0], button2: true}
      - {t_s: 3.1, position_m: [-0.02, 0.018, -0.018], rotation_deg: [0, 0, 0], button2: true}
      - {t_s: 3.5, position_m: [0.004, 0.018, -0.018], rotation_deg: [0, 0, 0], button2: true}
      - {t_s: 3.7, position_m: [0.03, 0.018, 0.03], rotation_deg: [0, 0, 0], button2: false}
)";

/// The contents of an image.
struct Moment {
  StateSnapshot state;
  RenderRequest request;
};

/// Returns states of a session without images, one per tick, from a time on.
std::vector<Moment> momentsOf(Session& session, const Strokes& strokes, const StateMirror& mirror, double from_s,
                              size_t count) {
  std::vector<Moment> out;
  while (out.size() < count) {
    const double time_s = static_cast<double>(session.tick() + 1) * session.tick_s();
    const Frame frame = session.step(strokes.at(time_s, session.scene().styluses), {});
    if (time_s < from_s) continue;
    out.emplace_back();
    Moment& moment = out.back();
    moment.state.bricks = mirror.shownBricks();
    session.solver().snapshot(moment.state);
    moment.request.tick = frame.tick;
    moment.request.motions = frame.tools;
    moment.request.cameras = frame.cameras;
    moment.request.outputs.cameras = {true};
    moment.request.outputs.every_image = true;
  }
  return out;
}

/// A rendering configuration. The last one is the reference.
struct Variant {
  const char *name, *stem;
  int supersampling;
  bool tools = true;
};
constexpr Variant kVariants[] = {{"automatic", "automatic", 0},
                                 {"automatic, without tools", "bare", 0, false},
                                 {"1 sample a pixel", "1", 1},
                                 {"4 samples a pixel", "4", 2}};
constexpr size_t kReference = std::size(kVariants) - 1;

/// Optional appearance of images, each by itself (docs/surface.md, Looks).
struct Extra {
  const char *name, *stem;
  void (*add)(CameraConfig&, Body&);
};
constexpr Extra kExtras[] = {
    {"none", "plain", [](CameraConfig&, Body&) {}},
    {"none, again", "again", [](CameraConfig&, Body&) {}},
    {"distortion", "distortion",
     [](CameraConfig& c, Body&) {
       c.distortion = {-0.4, 0.2, 0, 0, 0};
     }},
    {"light: lens", "lens", [](CameraConfig& c, Body&) { c.light = CameraLight::kLens; }},
    {"specular_wetness", "specular_wetness", [](CameraConfig&, Body& b) { b.specular_wetness = 0.5; }},
    {"contact_shadows", "contact", [](CameraConfig& c, Body&) { c.contact_shadows = 1; }},
    {"cut_wall_texture", "walls", [](CameraConfig&, Body& b) { b.cut_wall_texture = 1; }},
    {"blanching", "blanching", [](CameraConfig&, Body& b) { b.blanching = 1; }}};

/// Draws moments as a view does, on this thread.
class Painting {
 public:
  Painting(const Model& model, Scene scene, const Variant& variant) : tools_(variant.tools), mirror_(model) {
    scene.cameras[0].supersampling = variant.supersampling;
    scene_ = scene;
    view_ = std::make_unique<InlineView>(model, scene_);
  }
  Painting(const Model& model, const Scene& scene, const Extra& extra)
      : tools_(true), scene_(scene), own_(std::make_unique<Model>(model)), mirror_(*own_) {
    extra.add(scene_.cameras[0], own_->bodies[0]);
    view_ = std::make_unique<InlineView>(*own_, scene_);
  }

  std::vector<uint8_t> draw(const Moment& moment) {
    Pictures out;
    RenderRequest request = moment.request;
    if (!tools_) request.motions = {};
    mirror_.upload(moment.state);
    view_->wound(moment.state, moment.state.cut_revision);
    view_->capture(mirror_.view(), request, out, mirror_.displacements());
    view_->collect(out, true);
    return std::move(out.images.at(0).rgb);
  }

  /// Returns the times of an image by stage, each of which is waited for. [stages] seconds
  std::vector<double> stages(const std::vector<Moment>& moments) {
    draw(moments.back());
    const auto clock = gpu::StageClock::waiting();
    for (const Moment& moment : moments) draw(moment);
    std::vector<double> out;
    for (const auto& of : clock->collect(true)) out.push_back(of.seconds / static_cast<double>(moments.size()));
    return out;
  }

 private:
  bool tools_;
  Scene scene_;
  std::unique_ptr<Model> own_;  ///< for another appearance; null: the given model
  StateMirror mirror_;
  std::unique_ptr<InlineView> view_;
};

constexpr gpu::Stage kStagesOfPictures[] = {gpu::Stage::kUpload,   gpu::Stage::kSurface, gpu::Stage::kNormals,
                                            gpu::Stage::kMapping,  gpu::Stage::kRender,  gpu::Stage::kTissue,
                                            gpu::Stage::kLight,    gpu::Stage::kEdges,   gpu::Stage::kTools,
                                            gpu::Stage::kOverlays, gpu::Stage::kResolve, gpu::Stage::kReadback};

Table stageTable() {
  std::vector<Column> columns = {{"tissue"}, {"way"}, {"sum", "ms", 3}};
  for (const gpu::Stage stage : kStagesOfPictures) columns.push_back({gpu::stageName(stage), "ms", 3});
  return Table("stages of a picture of 640 x 480, waiting for each", columns);
}

void addStages(Table& table, const std::string& tissue, const Variant& variant, const std::vector<double>& seconds) {
  double sum = 0;
  for (const gpu::Stage stage : kStagesOfPictures) sum += seconds[static_cast<size_t>(stage)];
  std::vector<Cell> row = {tissue, variant.name, 1e3 * sum};
  for (const gpu::Stage stage : kStagesOfPictures) row.emplace_back(1e3 * seconds[static_cast<size_t>(stage)]);
  table.add(std::move(row));
}

/// Measures times of images in turn, so that other load of the machine affects all. @param seconds  total time
/// @returns  [paintings][]
std::vector<std::vector<double>> timesOf(const std::vector<std::unique_ptr<Painting>>& paintings,
                                         const std::vector<Moment>& moments, double seconds) {
  using Clock = std::chrono::steady_clock;
  std::vector<std::vector<double>> out(paintings.size());
  for (const auto& painting : paintings) painting->draw(moments.back());
  const Clock::time_point begun = Clock::now();
  for (size_t i = 0; i < 3 || std::chrono::duration<double>(Clock::now() - begun).count() < seconds; ++i) {
    for (size_t w = 0; w < paintings.size(); ++w) {
      const Clock::time_point start = Clock::now();
      paintings[w]->draw(moments[i % moments.size()]);
      out[w].push_back(std::chrono::duration<double>(Clock::now() - start).count());
    }
  }
  return out;
}

/// Results of all configurations for some moments.
class Comparison {
 public:
  Comparison(const Report& report, const Model& model, const Scene& scene, const std::vector<Moment>& moments)
      : moments_(moments) {
    for (const Variant& variant : kVariants) paintings_.push_back(std::make_unique<Painting>(model, scene, variant));
    took_s_ = timesOf(paintings_, moments_, report.isShort() ? 0.2 : 12);
    for (const Variant& variant : kVariants) compare(scene.cameras[0], &variant - kVariants);
  }

  double picture_s(size_t variant) const { return median(took_s_[variant]); }
  const Similarity& alike(size_t variant) const { return alike_[variant]; }
  std::vector<double> stages(size_t variant) const { return paintings_[variant]->stages(moments_); }
  /// Returns the image of the middle moment.
  const std::vector<uint8_t>& picture(size_t variant) const { return pictures_[variant]; }

 private:
  void compare(const CameraConfig& camera, ptrdiff_t variant) {
    Similarity mean{0, 0};
    for (const Moment& moment : moments_) {
      const std::vector<uint8_t> rgb = paintings_[static_cast<size_t>(variant)]->draw(moment),
                                 reference = paintings_[kReference]->draw(moment);
      const Similarity of = similarity(rgb, reference, camera.width_px, camera.height_px);
      mean.all += of.all / static_cast<double>(moments_.size());
      mean.seen += of.seen / static_cast<double>(moments_.size());
      if (&moment == &moments_[moments_.size() / 2]) pictures_.push_back(rgb);
    }
    alike_.push_back(mean);
  }

  const std::vector<Moment>& moments_;
  std::vector<std::unique_ptr<Painting>> paintings_;
  std::vector<std::vector<double>> took_s_;     ///< [ways]
  std::vector<Similarity> alike_;               ///< [ways]
  std::vector<std::vector<uint8_t>> pictures_;  ///< [ways]
};

struct Tables {
  Table pictures, stages, extras;
};

/// Measures the cost of each appearance, relative to an image without it.
void addExtras(Report& report, const std::string& tissue, const Model& model, const Scene& scene,
               const std::vector<Moment>& moments, Table& table) {
  std::vector<std::unique_ptr<Painting>> paintings;
  for (const Extra& extra : kExtras) paintings.push_back(std::make_unique<Painting>(model, scene, extra));
  const auto took_s = timesOf(paintings, moments, report.isShort() ? 0.2 : 24);
  for (size_t e = 0; e < std::size(kExtras); ++e) {
    std::vector<double> ratios;  // image by image, since those of a turn are drawn under the same load
    for (size_t i = 0; i < took_s[e].size(); ++i) ratios.push_back(took_s[e][i] / took_s[0][i]);
    table.add({tissue, kExtras[e].name, 1e3 * median(took_s[e]), median(ratios)});
    report.add(paintings[e]->draw(moments[moments.size() / 2]), scene.cameras[0].width_px, scene.cameras[0].height_px,
               tissue + "_with_" + kExtras[e].stem);
  }
}

void addRows(Report& report, const std::string& tissue, const Comparison& of, const CameraConfig& camera,
             Tables& tables) {
  for (size_t w = 0; w < std::size(kVariants); ++w) {
    const Variant& variant = kVariants[w];
    std::vector<Cell> row = {tissue, variant.name, 1e3 * of.picture_s(w), of.picture_s(w) / of.picture_s(kReference)};
    if (variant.tools) {
      row.insert(row.end(), {of.alike(w).all, of.alike(w).seen});
    } else {
      row.insert(row.end(), {"", ""});
    }
    tables.pictures.add(row);
    addStages(tables.stages, tissue, variant, of.stages(w));
    report.add(of.picture(w), camera.width_px, camera.height_px, tissue + "_" + variant.stem);
  }
  report.checkAtMost("time of a picture [s], " + tissue, of.picture_s(0), kWanted_s);
  report.checkAtLeast("SSIM to 4 samples a pixel, " + tissue, of.alike(0).all, kAlike);
}

}  // namespace

void pictureSuite(Report& report, gpu::Context& context) {
  const Scene scene = heartScene();
  report.stage("building");
  Session session(scene);
  Strokes strokes = parseStrokes(kStrokes, "strokes of bench picture");
  resolveAnchors(strokes, session.model());
  const StateMirror mirror(session.model());
  Tables tables = {
      Table("a picture of 640 x 480 of the heart in motion, on " + context.renderer(),
            {{"tissue"}, {"way"}, {"picture", "ms", 3}, {"over 4 samples"}, {"SSIM"}, {"SSIM without background"}}),
      stageTable(),
      Table("optional features of a picture (docs/surface.md), each alone",
            {{"tissue"}, {"with"}, {"picture", "ms", 3}, {"over none"}})};
  for (const auto& [tissue, from_s] : {std::pair("whole", kDent_s), std::pair("cut", kFlap_s)}) {
    report.stage(std::string(tissue) + ": stepping");
    const std::vector<Moment> moments = momentsOf(session, strokes, mirror, from_s, report.isShort() ? 2 : 12);
    report.stage(std::string(tissue) + ": drawing");
    const Comparison comparison(report, session.model(), scene, moments);
    addRows(report, tissue, comparison, scene.cameras[0], tables);
    report.stage(std::string(tissue) + ": looks");
    addExtras(report, tissue, session.model(), scene, moments, tables.extras);
  }
  report.add(tables.pictures, "pictures");
  report.add(tables.stages, "stages");
  report.add(tables.extras, "looks");
}

}  // namespace viscera::bench
