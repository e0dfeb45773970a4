// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <thread>

#include "cli/album.h"
#include "cli/commands.h"
#include "cli/film/film.h"
#include "cli/page/page.h"
#include "cli/run_folder.h"
#include "cli/run_plan.h"
#include "cli/scene_lookup.h"
#include "cli/task_run.h"
#include "math/out_file.h"
#include "session/session_replay.h"
#include "tasks/tool_log.h"
#include "viscera/gpu/context.h"
#include "viscera/math/error.h"
#include "viscera/math/state_hash.h"

namespace viscera::cli {

namespace {

using ReplayJson = nlohmann::ordered_json;
using ReplayClock = std::chrono::steady_clock;

/// Results of a replay: its sessions, their images and tables. Each piece without a jump of the state has a folder, the
/// first one the given folder.
class Replayed {
 public:
  /// @param film, page  null: none
  Replayed(const ReplayOptions& options, Film* film, Page* page)
      : options_(options), film_(film), page_(page), at_s_(options.from_s) {}

  Session& make(const Scene& scene) {
    end();
    session_.reset();
    context_.reset();
    context_ = contextFor(options_.no_view, scene);
    const Progress progress = consoleProgress();
    session_ =
        context_ ? std::make_unique<Session>(scene, *context_, progress) : std::make_unique<Session>(scene, progress);
    tasks_ = std::make_unique<TaskRun>(*session_, reportFolder(), !options_.no_view, options_.name.value_or(""),
                                       options_.page.file);
    return *session_;
  }
  FrameRequest outputs(const Session& session) {
    const bool begins = !tools_;
    if (begins) tools_.emplace(*session_);
    if ((film_ || !options_.out.empty()) && !album_) {
      ++pieces_;
      folder_ = options_.out + (pieces_ == 1 || options_.out.empty() ? "" : "/piece_" + std::to_string(pieces_));
      const auto pictures = options_.no_view ? Album::Pictures::kNone : Album::Pictures::kAll;
      album_ = std::make_unique<Album>(folder_, session.scene(), Strokes{}, UINT64_MAX, pictures,
                                       Album::Kinds{options_.depth, options_.labels}, film_);
    }
    if (page_ && begins) page_->begin(*session_, album_.get(), &tasks_->watch(), at_s_);
    return album_ ? album_->outputs(session) : FrameRequest{};
  }
  void stepped(Frame&& frame, double at_s) {
    at_s_ = at_s;
    if (album_) album_->add(std::move(frame));
    if (page_) page_->stepped(*session_, album_.get(), at_s);
    if (options_.speed > 0)
      std::this_thread::sleep_until(begun_ +
                                    std::chrono::duration_cast<ReplayClock::duration>(
                                        std::chrono::duration<double>((at_s - options_.from_s) / options_.speed)));
  }
  /// Writes images and tables since the last jump; measures are kept.
  void endPiece() {
    if (!session_ || !tools_) return;
    if (page_) page_->end(*session_, album_.get());
    Frame last = session_->drain();
    measures_.push_back(tools_->rows().metrics());
    if (album_) {
      album_->add(std::move(last));
      if (!folder_.empty()) addSkin();
      album_->finish();
      if (!folder_.empty()) writeTools(tools_->rows(), folder_);
    }
    album_.reset();
    tools_.reset();
  }
  /// Ends the piece and the tasks of the session.
  void end() {
    endPiece();
    if (!tasks_) return;
    for (ReplayJson& judged : tasks_->finish()) judged_.push_back(std::move(judged));
    tasks_->printVerdicts();
    tasks_.reset();
  }
  const ReplayJson& judged() const { return judged_; }
  Session& session() { return *session_; }
  const ReplayJson& measures() const { return measures_; }

 private:
  void addSkin() { album_->add(frameNow(*session_, album_.get())); }
  std::string reportFolder() {
    if (options_.out.empty()) return "";
    return options_.out + (++scenes_ == 1 ? "/report" : "/report_" + std::to_string(scenes_));
  }

  const ReplayOptions& options_;
  Film* const film_;
  Page* const page_;
  double at_s_;  ///< time in the recording after the last step
  std::unique_ptr<gpu::Context> context_;
  std::unique_ptr<Session> session_;
  std::optional<ToolLog> tools_;
  std::unique_ptr<TaskRun> tasks_;
  std::unique_ptr<Album> album_;
  std::string folder_;
  int pieces_ = 0, scenes_ = 0;
  ReplayJson measures_ = ReplayJson::array(), judged_ = ReplayJson::array();
  const ReplayClock::time_point begun_ = ReplayClock::now();
};

void tell(const SessionReplay& replay) {
  std::cout << "recorded: " << replay.duration_s() << " s\n";
  for (const SessionReplay::Part& part : replay.parts())
    std::cout << "from " << part.from_s << " s to " << part.to_s << " s: stepped by " << part.scene.stepped_by << '\n';
  if (!replay.damage().empty()) std::cerr << "viscera: " << replay.damage() << "; it is replayed up to that point\n";
}

std::string differenceText(const SessionReplay::Difference& it) {
  std::string out = "states differ first at tick " + std::to_string(it.tick) + " of scene " +
                    std::to_string(it.part + 1) + ": recorded " + StateHash::text(it.recorded_hash) + ", replayed " +
                    StateHash::text(it.replayed_hash) + "; at tick " + std::to_string(it.last_same_tick) +
                    " they were equal";
  if (it.measured_tick) out += "; measurements differ first at tick " + std::to_string(*it.measured_tick);
  return out;
}

ReplayJson resultOf(const SessionReplay& replay, const SessionReplay::Outcome& outcome, Session& session) {
  ReplayJson out;
  out["scene"] = session.scene().name;
  out["recorded_s"] = replay.duration_s();
  out["replayed_to_s"] = outcome.at_s;
  out["steps"] = outcome.steps;
  out["state_hash"] = StateHash::text(session.stateHash());
  out["hashes_compared"] = outcome.compared;
  out["recorded_hash_met"] = !outcome.difference;
  out["to_recorded_end"] = outcome.ended;
  if (outcome.difference) out["differs"] = differenceText(*outcome.difference);
  if (!replay.damage().empty()) out["cut"] = replay.damage();
  out["stepped_by"] = session.backendNote();
  return out;
}

/// Starts the film of the recorded sessions that are shown. Returns null if none is requested.
std::unique_ptr<Film> beginFilm(const ReplayOptions& options, const SessionReplay& recording, double until_s) {
  if (options.film.file.empty()) return nullptr;
  FilmFormat format;
  for (size_t p = 0; p < recording.parts().size(); ++p) {
    const SessionReplay::Part& part = recording.parts()[p];
    if (part.to_s < options.from_s || part.from_s > until_s) continue;
    const std::string name = options.file + " (scene " + std::to_string(p + 1) + ")";
    format.include(filmFormat(options.film, part.scene.scene(name, options.overrides), name));
  }
  if (format.rate_hz == 0) throw Error("--film: the recording ends before --from");
  return std::make_unique<Film>(options.film, format);
}

}  // namespace

int replay(const ReplayOptions& options) {
  requireFilm(options.film, options.no_view);
  requirePage(options.page);
  requireTrainee(options.name);
  SessionReplay recording(options.file);
  tell(recording);
  const double until_s = options.until_s.value_or(recording.duration_s());
  if (until_s < options.from_s) throw Error("--until must not be before --from");
  if (options.no_view && (options.depth || options.labels))
    throw Error(std::string(options.depth ? "--depth" : "--labels") + ": needs pictures; remove --no-view");
  std::vector<Output> outputs = outputsIn(options.out);
  outputs.push_back({"--save", options.save, FileKind::kState});
  outputs.push_back({"--film", options.film.file, FileKind::kFilm});
  outputs.push_back({"--page", options.page.file, FileKind::kHtml});
  requireOutputs(outputs);
  const RunFolder folder(options.out);
  const std::unique_ptr<Film> film = beginFilm(options, recording, until_s);
  const std::unique_ptr<Page> page = options.page.file.empty() ? nullptr : std::make_unique<Page>(options.page);
  Replayed replayed(options, film.get(), page.get());
  SessionReplay::Ports ports;
  ports.make = [&](const Scene& scene, size_t) -> Session& { return replayed.make(scene); };
  ports.leaps = [&](Session&) { replayed.endPiece(); };
  ports.outputs = [&](const Session& session) { return replayed.outputs(session); };
  ports.stepped = [&](Session&, Frame&& frame, double at_s) { replayed.stepped(std::move(frame), at_s); };
  const SessionReplay::Outcome outcome = recording.run(options.from_s, until_s, options.overrides, ports);
  replayed.end();
  if (film) film->finish();
  if (page) page->finish();
  if (!options.save.empty()) replayed.session().save(options.save);
  ReplayJson result = resultOf(recording, outcome, replayed.session());
  result["pieces"] = replayed.measures();
  if (!replayed.judged().empty()) result["tasks"] = replayed.judged();
  if (!options.out.empty()) {
    writeFile(options.out + "/metrics.json", FileKind::kJson,
              result.dump(2, ' ', false, ReplayJson::error_handler_t::replace) + '\n');
  }
  std::cout << result.dump(-1, ' ', false, ReplayJson::error_handler_t::replace) << std::endl;
  if (outcome.difference) std::cerr << "viscera: " << differenceText(*outcome.difference) << '\n';
  return outcome.difference ? 1 : 0;
}

}  // namespace viscera::cli
