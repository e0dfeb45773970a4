// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>
#include <utility>

#include "cli/album.h"
#include "cli/commands.h"
#include "cli/film/film.h"
#include "cli/page/page.h"
#include "cli/run_folder.h"
#include "cli/run_metrics.h"
#include "cli/run_plan.h"
#include "cli/scene_lookup.h"
#include "cli/task_run.h"
#include "math/number_text.h"
#include "math/one_line.h"
#include "math/out_file.h"
#include "model/fracture/toughness.h"
#include "model/scene/tool_kinds.h"
#include "session/session_recorder.h"
#include "tasks/tool_log.h"
#include "viscera/gpu/context.h"
#include "viscera/math/error.h"
#include "viscera/session/session.h"
#include "viscera/session/tissue_processes.h"
#include "viscera/tools/strokes.h"

namespace viscera::cli {

namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Json metricsOf(const Session& session, const layout::TickStats& stats, const std::string& renderer, double wall_s) {
  const Counters counters = session.counters();
  RunMetrics metrics{session.scene().name, session.model()};
  metrics.springs_cut = stats.springs_cut;
  metrics.substeps = counters.substeps;
  metrics.dt_s = session.solver().dt_s();
  metrics.dt_safe_s = session.solver().dtSafe_s();
  metrics.dt_limit_s = session.solver().dtLimit_s();
  metrics.simulated_s = static_cast<double>(counters.ticks) * session.tick_s();
  metrics.wall_s = wall_s;
  metrics.state_hash = session.stateHash();
  metrics.extremes = session.extremes();
  metrics.facts = session.facts();
  metrics.images = counters.renders;
  metrics.images_skipped = counters.skipped;
  metrics.backend = session.solver().backend();
  metrics.renderer = renderer;
  metrics.stepped_by = session.backendNote();
  return toJson(metrics);
}

Album::Pictures picturesOf(const RunOptions& options) {
  if (options.no_view) return Album::Pictures::kNone;
  return options.live ? Album::Pictures::kLive : Album::Pictures::kAll;
}

/// Restores a state. @throws Error  it was saved after the end of this run, or an error of Session::restore()
void resume(Session& session, const std::string& file, uint64_t ticks) {
  session.restore(file);
  const double at_s = static_cast<double>(session.tick()) * session.tick_s();
  if (session.tick() > ticks) {
    throw Error(file + ": was saved after " + numberText(at_s) + " s, but the run ends at " +
                numberText(static_cast<double>(ticks) * session.tick_s()) + " s; give a later end with --seconds");
  }
  std::cout << "resumed after " << at_s << " s, tick " << session.tick() << '\n';
}

/// Exports a state. Images that are ready go to the album.
void exportNow(Session& session, Exporter& exporter, Album& album) {
  if (!exporter.ofSkin()) return exporter.add(session, {});
  exporter.add(session, *frameNow(session, &album).surface);
}

/// Returns the number of ticks between two saved states; 0: none.
uint64_t saveTicks(double every_s, double tick_s) {
  return every_s > 0 ? std::max<uint64_t>(1, static_cast<uint64_t>(std::llround(every_s / tick_s))) : 0;
}

/// Checks, after a replay of a whole recording, that it ends in the recorded state.
void compareWithRecording(const Strokes& strokes, uint64_t ticks, Json& metrics) {
  const std::string& recorded = strokes.recorded.state_hash;
  if (recorded.empty() || ticks != strokes.ticks) return;
  const std::string replayed = metrics["state_hash"];
  metrics["recorded_hash_met"] = replayed == recorded;
  if (replayed == recorded) return;
  std::cerr << "viscera: " << strokes.file << " was recorded with state hash " << recorded
            << ", but this run ends with " << replayed << "; the scene, the overrides or the machine differ\n";
}

/// Starts the task. Returns null if there is none.
std::unique_ptr<TaskRun> beginTask(Session& session, const RunOptions& options) {
  if (options.task.empty()) return nullptr;
  auto out = std::make_unique<TaskRun>(session, options.out.empty() ? "" : options.out + "/report", !options.no_view,
                                       options.name.value_or(""), options.page.file);
  out->begin(loadTask(options.task));
  return out;
}

/// Prints which styluses of the strokes are outside the workspace of a device.
void sayFarTools(const Strokes& strokes, const Scene& scene) {
  for (const StylusConfig& stylus : scene.styluses) {
    double farthest_m = 0;
    for (const Stroke& stroke : strokes.strokes) {
      if (stroke.stylus != stylus.name) continue;
      for (const Stroke::Key& key : stroke.keys) farthest_m = std::max(farthest_m, key.pose.position_m.norm());
      for (const Stroke::Sample& sample : stroke.samples)
        farthest_m = std::max(farthest_m, sample.pose.position_m.norm());
    }
    if (farthest_m > stylus.workspace_m)
      std::cout << strokes.file << ": stylus '" << stylus.name << "' goes " << numberText(farthest_m)
                << " m from the tissue frame, beyond its workspace_m of " << numberText(stylus.workspace_m)
                << " m; poses of a device there would be refused\n";
  }
}

/// Checks the options. @throws Error  an option requests files that this run does not have
void requireSomethingToWrite(const RunOptions& options, const Session& session, uint64_t ticks) {
  const Scene& scene = session.scene();
  const bool pictures = !options.no_view && !scene.cameras.empty();
  if ((options.depth || options.labels) && !pictures)
    throw Error(std::string(options.depth ? "--depth" : "--labels") + ": needs pictures; " +
                (options.no_view ? "remove --no-view" : "the scene has no cameras"));
  if (!options.exported) return;
  const std::vector<Body>& bodies = session.model().bodies;
  const auto isNetwork = [](const Body& body) { return body.network.has_value(); };
  if (options.exported->source == ExportSource::kSutures && scene.sutures.empty())
    throw Error("--export sutures: the scene has no sutures");
  if (options.exported->source == ExportSource::kNetwork && std::none_of(bodies.begin(), bodies.end(), isNetwork))
    throw Error("--export network: no body has structure explicit or surface");
  const double run_s = static_cast<double>(ticks) * session.tick_s();
  if (options.exported->every_s > run_s + session.tick_s() / 2)
    throw Error("--every " + numberText(options.exported->every_s) + " s is longer than the run, " + numberText(run_s) +
                " s; nothing would be exported");
}

std::vector<Output> outputsOf(const RunOptions& options) {
  std::vector<Output> out = outputsIn(options.out);
  out.push_back({"--save", options.save, FileKind::kState});
  out.push_back({"--record", options.record, FileKind::kRecording});
  out.push_back({"--film", options.film.file, FileKind::kFilm});
  out.push_back({"--page", options.page.file, FileKind::kHtml});
  return out;
}

/// Ends a recording. @throws Error  it is not complete
void finish(SessionRecorder& recorder) {
  recorder.leave();
  recorder.finish();
  if (!recorder.fault().empty()) throw Error(recorder.fault());
}

/// Prints notes on a session before its first step.
void printNotes(const Session& session, const std::vector<std::string>& stroke_notes) {
  for (const Body& body : session.model().bodies) {
    for (const std::string& note : body.notes) std::cout << body.name << ": " << oneLine(note) << '\n';
  }
  for (const std::string& note : stroke_notes) std::cout << "strokes: " << oneLine(note) << '\n';
  std::cout << "stepped by: " << session.backendNote() << '\n';
}

void printRecording(const Strokes& strokes) {
  if (strokes.recorded.scene.empty()) return;
  std::cout << "strokes: recorded of scene " << strokes.recorded.scene
            << ", overrides: " << (strokes.recorded.overrides.empty() ? "none" : strokes.recorded.overrides) << '\n';
}

/// Checks the options of a film and a page before anything is computed. @throws Error
void requireFilmOf(const RunOptions& options, const Scene& scene) {
  requirePage(options.page);
  requireFilm(options.film, options.no_view);
  if (!options.film.file.empty()) filmCamera(options.film, scene, "scene " + scene.name);
}

/// Starts a film. Returns null if none is requested.
std::unique_ptr<Film> beginFilm(const FilmOptions& options, const Scene& scene) {
  if (options.file.empty()) return nullptr;
  return std::make_unique<Film>(options, filmFormat(options, scene, "scene " + scene.name));
}

/// Starts a page with the state before the first step. Returns null if none is requested.
std::unique_ptr<Page> beginPage(const RunOptions& options, Session& session, Album& album, const TaskRun* task,
                                const Strokes& strokes) {
  if (options.page.file.empty()) return nullptr;
  auto out = std::make_unique<Page>(options.page);
  const double begin_s = static_cast<double>(session.tick()) * session.tick_s();
  for (const Mark& mark : strokes.marks)
    if (mark.time_s >= begin_s) out->addMark(mark.name, mark.time_s);
  out->begin(session, &album, task ? &task->watch() : nullptr, begin_s);
  return out;
}

/// Completes what a run has written in its steps. @param film, page, exporter  null: none   @throws Error
void finishFiles(Session& session, Album& album, Film* film, Page* page, Exporter* exporter) {
  if (page) page->end(session, &album);
  album.finish();
  if (film) film->finish();
  if (page) page->finish();
  if (exporter) exporter->finish();
}

/// Prints the verdict of a task, if there is one, and the metrics as the last line. @param folder  also gets the
/// metrics as a file; empty: none
void putMetrics(const Json& metrics, const TaskRun* task, const std::string& folder) {
  if (!folder.empty())
    writeFile(folder + "/metrics.json", FileKind::kJson,
              metrics.dump(2, ' ', false, Json::error_handler_t::replace) + '\n');
  if (task) task->printVerdicts();
  std::cout << metrics.dump(-1, ' ', false, Json::error_handler_t::replace) << std::endl;
}

}  // namespace

int run(const RunOptions& options) {
  RunPlan plan = planRun(options);
  requireFilmOf(options, plan.scene);
  const std::vector<Output> outputs = outputsOf(options);
  requireOutputs(outputs);
  const uint64_t ticks = plan.ticks;
  const Scene& scene = plan.scene;
  Strokes& strokes = plan.strokes;

  const std::unique_ptr<gpu::Context> context = contextFor(options.no_view, scene);
  const Progress progress = consoleProgress();
  const auto made =
      context ? std::make_unique<Session>(scene, *context, progress) : std::make_unique<Session>(scene, progress);
  Session& session = *made;
  requireOutputs(outputs);  // all inputs are known at this point
  requireSomethingToWrite(options, session, ticks);
  const std::vector<std::string> stroke_notes = resolveAnchors(strokes, session.model(), scene.fit);
  sayFarTools(strokes, scene);
  printNotes(session, stroke_notes);
  const RunFolder folder(options.out);
  const std::unique_ptr<Film> film = beginFilm(options.film, scene);
  Album album(options.out, session.scene(), strokes, ticks, picturesOf(options), {options.depth, options.labels},
              film.get());
  printRecording(strokes);
  if (!options.resume.empty()) resume(session, options.resume, ticks);
  std::optional<ToolLog> tools;
  if (!options.strokes.empty()) tools.emplace(session);
  std::optional<SessionRecorder> recorder;
  if (!options.record.empty()) recorder.emplace(options.record).follow(session);
  const std::unique_ptr<TaskRun> task = beginTask(session, options);
  const std::unique_ptr<Page> page = beginPage(options, session, album, task.get(), strokes);
  const uint64_t save_ticks = saveTicks(options.save_every_s, session.tick_s());
  std::optional<Exporter> exporter;
  if (options.exported) exporter.emplace(options.out + "/export", *options.exported, session.tick_s());
  const Clock::time_point start = Clock::now();
  for (uint64_t t = session.tick(); t < ticks; ++t) {
    const double time_s = static_cast<double>(t + 1) * session.tick_s();
    if (strokes.inputReset(t + 1)) session.resetInput();
    album.add(session.step(strokes.at(time_s, scene.styluses), album.outputs(session)));
    progress("simulating", static_cast<double>(t + 1) / static_cast<double>(ticks));
    if (page) page->stepped(session, &album, time_s);
    if (exporter && exporter->isDue(t + 1)) exportNow(session, *exporter, album);
    if (save_ticks > 0 && (t + 1) % save_ticks == 0) session.save(options.save);
  }
  Frame last = session.drain();
  const double wall_s = secondsSince(start);
  const layout::TickStats stats = last.stats;
  album.add(std::move(last));
  finishFiles(session, album, film.get(), page.get(), exporter ? &*exporter : nullptr);
  if (!options.save.empty()) session.save(options.save);
  if (recorder) finish(*recorder);

  Json metrics = metricsOf(session, stats, context ? context->renderer() : "none", wall_s);
  compareWithRecording(strokes, ticks, metrics);
  if (tools) metrics["tools"] = tools->rows().metrics();
  if (task) metrics["tasks"] = task->finish();
  if (tools && !options.out.empty()) writeTools(tools->rows(), options.out);
  putMetrics(metrics, task.get(), options.out);
  return 0;
}

}  // namespace viscera::cli
