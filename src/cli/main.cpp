// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <map>

#include "cli/commands.h"
#include "cli/fault.h"
#include "cli/film/film_options.h"
#include "cli/page/page_options.h"
#include "devices/device_profile.h"
#include "math/memory_for.h"
#include "model/scene/feature_rules.h"
#include "model/scene/tissue_presets.h"
#include "tasks/task.h"
#include "viscera/math/error.h"

using namespace viscera;

namespace {

struct Options {
  int device = -1;
  cli::RunOptions run;
  cli::ReplayOptions replay;
  cli::ReportOptions report;
  cli::SweepOptions sweep;
  cli::ImportOptions import;
  ExportOptions exported;
  CLI::Option* exports = nullptr;  // option run --export
  std::string keys_of;
  std::vector<std::string> upgraded;
  std::vector<double> window;  // option of import; empty: not given
};

CLI::Option* addOverrides(CLI::App* command, Overrides& overrides) {
  return command
      ->add_option("--set", overrides, "key=value: replaces one value of the scene, as in bodies[0].spacing_m=0.003")
      ->allow_extra_args(false);
}

CLI::App* addCheck(CLI::App& app, Options& o) {
  CLI::App* check = app.add_subcommand(
      "check",
      "list the EGL devices, which of them is used and why the others are not; or measure the walls of a scene");
  CLI::Option* device = check->add_option("--device", o.device, "use only this device");
  CLI::Option* scene = check->add_option(
      "scene", o.run.scene, "scene to print the thickness of its walls for, in cells, and the error to expect from it");
  scene->excludes(device);
  addOverrides(check, o.run.overrides)->needs(scene);
  return check;
}

/// Adds the export options of `run`. @param out  its option --out
void addExports(CLI::App* run, CLI::Option* out, Options& o) {
  using Source = ExportSource;
  using Format = ExportFormat;
  const auto sources = cli::oneOf<Source>({{"skin", Source::kSkin},
                                           {"lattice", Source::kLattice},
                                           {"network", Source::kNetwork},
                                           {"sutures", Source::kSutures}});
  const auto formats = cli::oneOf<Format>({{"vtp", Format::kVtp},
                                           {"xdmf", Format::kXdmf},
                                           {"ply", Format::kPly},
                                           {"glb", Format::kGlb},
                                           {"pc2", Format::kPc2},
                                           {"usda", Format::kUsda}});
  const auto frames = cli::oneOf<ExportFrame>({{"ros", ExportFrame::kRos}, {"lps_mm", ExportFrame::kLpsMm}});
  CLI::Option* exported = o.exports =
      run->add_option("--export", o.exported.source,
                      "object to export into DIR/export: skin, lattice, network or sutures")
          ->transform(sources)
          ->needs(out);
  run->add_option("--every", o.exported.every_s, "simulated seconds between two exports; default 0.1")
      ->check(CLI::Range(1e-6, 86400.0))
      ->needs(exported);
  run->add_option("--format", o.exported.format, "format of exports: vtp, xdmf, ply, glb, pc2 or usda; default vtp")
      ->transform(formats)
      ->type_name("NAME")
      ->needs(exported);
  run->add_option("--export-frame", o.exported.frame, "axes and unit of exports: ros, or lps_mm as 3D Slicer has them")
      ->transform(frames)
      ->type_name("NAME")
      ->needs(exported);
}

/// Adds options that `run` had and --help no longer lists: they report the command to use instead.
void addMoved(CLI::App* run) {
  for (const std::string option : {"--reference", "--compare"}) {
    run->add_flag_callback(option,
                           [option] {
                             throw cli::CommandLineError(
                                 "command line: run has no option " + option +
                                     "; use `viscera bench reference SCENE [--compare]` instead",
                                 static_cast<int>(CLI::ExitCodes::ExtrasError));
                           })
        ->group("");
  }
}

CLI::App* addRun(CLI::App& app, Options& o) {
  CLI::App* run = app.add_subcommand("run", "run a scene without ROS; prints one JSON object as its last line");
  run->add_option("scene", o.run.scene, "scene file, or name of a shipped scene")->required();
  run->add_option("--mesh", o.run.mesh, "mesh file that becomes the first body");
  run->add_option("--strokes", o.run.strokes, "recorded strokes to replay");
  run->add_option("--seconds", o.run.seconds, "simulated time; default: the strokes' length, or 1")
      ->check(CLI::Range(0.0, 86400.0));
  CLI::Option* out = run->add_option("--out", o.run.out,
                                     "folder for pictures, metrics.json, tools.csv, kinematics.txt and surface.ply, "
                                     "the surface mesh at the end; files of an older run are removed");
  run->add_flag("--live", o.run.live,
                "skip pictures instead of waiting for them, as a live session does, except at marks")
      ->needs(out)
      ->excludes(addFilm(run, o.run.film));
  addPage(run, o.run.page);
  run->add_flag(
         "--depth", o.run.depth,
         "write the depths of every picture: .npy, float32, metres along the optical axis, +Inf where there is nothing")
      ->needs(out);
  run->add_flag("--labels", o.run.labels,
                "write the labels of every picture, the object that each pixel shows: grey .png (docs/ros_api.md)")
      ->needs(out);
  addExports(run, out, o);
  CLI::Option* save =
      run->add_option("--save", o.run.save, "file for the state at the end, from which --resume continues");
  run->add_option("--save-every", o.run.save_every_s, "simulated seconds between two saved states")
      ->check(CLI::Range(1e-6, 86400.0))
      ->needs(save);
  run->add_option("--record", o.run.record, "new file that records the session, for viscera replay");
  run->add_option("--resume", o.run.resume, "saved state of this scene to continue from, up to the same end time");
  run->add_flag("--no-view", o.run.no_view,
                "run without pictures, and without OpenGL unless solver.backend: gpu needs it");
  addOverrides(run, o.run.overrides);
  addMoved(run);
  return run;
}

CLI::App* addReplay(CLI::App& app, Options& options) {
  cli::ReplayOptions& o = options.replay;
  CLI::App* replay = app.add_subcommand("replay", "replay a recorded session; prints one JSON object as its last line");
  replay->add_option("file", o.file, "recording made by `viscera run --record` or the simulator")->required();
  const CLI::Range seconds(0.0, 1e6);
  replay->add_option("--from", o.from_s, "time in the recording at which the replay begins, in seconds")
      ->check(seconds);
  replay->add_option("--until", o.until_s, "time in the recording at which the replay ends, in seconds")
      ->check(seconds);
  replay->add_option("--speed", o.speed, "speed relative to the recorded session; default: as fast as possible")
      ->check(CLI::Range(1e-3, 1e3));
  CLI::Option* out = replay->add_option("--out", o.out,
                                        "folder for pictures, metrics.json, tools.csv, kinematics.txt and surface.ply; "
                                        "files of an older run are removed");
  replay->add_flag("--depth", o.depth, "write the depths of every picture, as run does")->needs(out);
  replay->add_flag("--labels", o.labels, "write the labels of every picture, as run does")->needs(out);
  addFilm(replay, o.film);
  addPage(replay, o.page);
  replay->add_flag("--no-view", o.no_view,
                   "run without pictures, and without OpenGL unless solver.backend: gpu needs it");
  replay->add_option("--name", o.name, "name of the trainee, for the report of a task");
  replay->add_option("--save", o.save, "file for the state at the end, from which run --resume continues");
  replay
      ->add_option(
          "--set", o.overrides,
          "key=value: replaces one value of the scene that does not change its state, as in cameras[0].position_m")
      ->allow_extra_args(false);
  return replay;
}

CLI::App* addTask(CLI::App& app, Options& o) {
  CLI::App* task = app.add_subcommand(
      "task",
      "judge a user in a task (docs/lessons/tasks.md); prints the verdict, and one JSON object as its last line");
  task->add_option("task", o.run.task, "task file, or name of a shipped task")->required();
  task->add_option("--strokes", o.run.strokes, "recorded strokes of the user");
  task->add_option("--seconds", o.run.seconds, "simulated time; default: the strokes' length, or 1")
      ->check(CLI::Range(0.0, 86400.0));
  task->add_option("--out", o.run.out, "folder for pictures and tables, as for run, and for the report");
  addFilm(task, o.run.film);
  addPage(task, o.run.page);
  task->add_option("--name", o.run.name, "name of the trainee, for the report; at most 64 characters");
  task->add_flag("--no-view", o.run.no_view,
                 "run without pictures, and without OpenGL unless solver.backend: gpu needs it");
  task->add_option("--record", o.run.record, "new file that records the session, for viscera replay");
  addOverrides(task, o.run.overrides);
  return task;
}

CLI::App* addReport(CLI::App& app, Options& o) {
  CLI::App* report = app.add_subcommand(
      "report", "write a page with the progress of trainees, from the reports of `viscera task --out` in a folder");
  report->add_option("folder", o.report.folder, "folder that is searched, with its subfolders, for files report.json")
      ->required();
  report->add_option("--out", o.report.out, "page to write; default: progress.html in the folder");
  return report;
}

CLI::App* addSettle(CLI::App& app, Options& o) {
  CLI::App* settle =
      app.add_subcommand("settle", "find the equilibrium of a scene under its weight; prints one JSON object");
  settle->add_option("scene", o.run.scene, "scene file, or name of a shipped scene")->required();
  settle->add_option("--mesh", o.run.mesh, "mesh file that becomes the first body");
  addOverrides(settle, o.run.overrides);
  return settle;
}

CLI::App* addFit(CLI::App& app, Options& o) {
  CLI::App* fit =
      app.add_subcommand("fit", "write a scene file with another organ, to which the rest of the scene is fitted");
  fit->add_option("scene", o.run.scene, "scene file, or name of a shipped scene")->required();
  fit->add_option("--mesh", o.run.mesh, "mesh file that becomes the first body")->required();
  fit->add_option("--out", o.run.out, "scene file to write")->required();
  addOverrides(fit, o.run.overrides);
  return fit;
}

CLI::App* addAnchor(CLI::App& app, Options& o) {
  CLI::App* anchor = app.add_subcommand("anchor", "write strokes that are anchored to the surface as absolute ones");
  anchor->add_option("scene", o.run.scene, "scene file, or name of a shipped scene")->required();
  anchor->add_option("--strokes", o.run.strokes, "strokes file with anchors")->required();
  anchor->add_option("--mesh", o.run.mesh, "mesh file that becomes the first body");
  anchor->add_option("--out", o.run.out, "strokes file to write")->required();
  addOverrides(anchor, o.run.overrides);
  return anchor;
}

CLI::App* addImport(CLI::App& app, Options& options) {
  cli::ImportOptions& o = options.import;
  CLI::App* import = app.add_subcommand("import", "make a scene from the organs of a scan (docs/scans.md)");
  import->add_option("scan", o.scan, "NIfTI, NRRD, MetaImage or DICOM file, or folder of DICOM files")->required();
  CLI::Option* list = import->add_flag("--list", o.list, "list the contents of the scan, and write nothing");
  CLI::Option* labels =
      import->add_option("--labels", o.labels.labels, "numbers or names of labels, separated by commas; default: all")
          ->delimiter(',');
  CLI::Option* values = import
                            ->add_option("--window", options.window,
                                         "LO,HI: range of values that are taken for tissue, for CT in Hounsfield "
                                         "units; this is not a segmentation")
                            ->delimiter(',')
                            ->expected(2)
                            ->excludes(labels);
  import
      ->add_option("--closing-mm", o.window.closing_mm,
                   "half the width below which gaps are closed, in mm; 0 .. 20; default 0")
      ->check(CLI::Range(0.0, 20.0))
      ->needs(values);
  import->add_option("--pieces", o.window.pieces, "number of pieces to keep, the largest ones; default 1; 0: all")
      ->check(CLI::Range(0, 1'000'000))
      ->needs(values);
  import->add_flag("--fill-holes", o.window.fill_holes, "fill holes that tissue encloses")->needs(values);
  import
      ->add_option("--spacing", o.spacing_m,
                   "spacing of all lattices [m]; default: about 20,000 nodes for the largest organ")
      ->check(CLI::Range(1e-5, 10.0));
  import
      ->add_flag("--one-body", o.one_body, "make the labels parts of one body, read from the scan itself: none slides")
      ->excludes(values);
  import->add_option("--rigid", o.rigid, "labels that are held in space, such as bone, separated by commas")
      ->delimiter(',')
      ->excludes(values);
  import->add_option("--names", o.labels.names_file, "table of label names, of ITK-SNAP or YAML");
  import->add_option("--axes", o.labels.axes,
                     "directions of the axes i, j, k, as in LPS, for a file that does not state them");
  import->add_option("--transform", o.labels.transform,
                     "transform to use, sform or qform, for a NIfTI file with two that differ");
  import->add_option("--volume", o.labels.volume, "index of the volume in a file with several, from 0")
      ->check(CLI::Range(0, 1'000'000));
  import->add_option("--series", o.labels.series, "number or UID of a DICOM series; all: the series are one volume");
  import->add_flag("--fill-slices", o.labels.fill_slices, "fill missing slices of DICOM with the nearest one")
      ->excludes("--one-body");
  import->add_option("--grey", o.grey, "scan on which the labels were drawn, for the previews")->excludes(values);
  import->add_flag("--smooth", o.smooth, "read a label map that was refined by repeating voxels as it was before")
      ->excludes(values)
      ->excludes("--one-body");
  import->add_flag("--no-previews", o.no_previews, "write no pictures of organs and slices");
  import->add_option("--out", o.out, "new folder for scene.yaml and its meshes")->excludes(list);
  return import;
}

CLI::App* addSweep(CLI::App& app, Options& o) {
  CLI::App* sweep = app.add_subcommand("sweep", "run many sessions that differ in scene keys; writes one table");
  sweep->add_option("plan", o.sweep.plan, "file with the runs (docs/cluster.md)")->required();
  sweep
      ->add_option("--out", o.sweep.out,
                   "folder for results.csv and the runs; processes with the same folder share the runs")
      ->required();
  sweep
      ->add_option("--jobs", o.sweep.jobs,
                   "sessions at the same time; 0, the default: one per processor that may be used")
      ->check(CLI::Range(0, 1024));
  sweep->add_option("--tries", o.sweep.tries, "number of failures after which a run is abandoned; default 2")
      ->check(CLI::Range(1, 100));
  sweep
      ->add_option("--run-limit-s", o.sweep.run_limit_s,
                   "seconds after which a run is killed and counts as failed; default 86400, a day; 0: never")
      ->check(CLI::Range(0, 100'000'000));
  CLI::Option* slurm =
      sweep->add_option("--slurm", o.sweep.slurm, "number of workers of the job array that is submitted to Slurm")
          ->check(CLI::Range(1, 100000));
  sweep
      ->add_option("--sbatch", o.sweep.sbatch,
                   "further options for Slurm's sbatch, as in '--cpus-per-task=8 --time=60'")
      ->needs(slurm);
  sweep->add_flag("--retry", o.sweep.retry, "retry the runs that were abandoned");
  return sweep;
}

/// Adds `bench` to the list of commands; main() handles its options.
CLI::App* addBench(CLI::App& app, Options&) {
  return app.add_subcommand("bench", "measure accuracy and speed; `viscera bench --help` lists the suites");
}

CLI::App* addKeys(CLI::App& app, Options& o) {
  CLI::App* keys = app.add_subcommand("keys", "print the table of a file's keys, of features or of tissues");
  keys->add_option("file", o.keys_of,
                   "table to print: scene, device (profiles of config/devices), task (files of config/tasks), features "
                   "(which ones can be combined) or tissues (names for material.tissue); default scene")
      ->check(CLI::IsMember({"scene", "device", "task", "features", "tissues"}));
  return keys;
}

CLI::App* addUpgrade(CLI::App& app, Options& o) {
  CLI::App* upgrade = app.add_subcommand("upgrade", "rename old keys of files to those of this version, in place");
  upgrade->add_option("files", o.upgraded, "scene, strokes, task and sweep files")->required();
  return upgrade;
}

int importScan(Options& o) {
  if (!o.import.list && o.import.out.empty())
    throw cli::CommandLineError("command line: import: --out DIR or --list is required",
                                static_cast<int>(CLI::ExitCodes::RequiredError));
  o.import.by_window = !o.window.empty();
  if (o.import.by_window) o.import.window.low = o.window[0], o.import.window.high = o.window[1];
  return memoryFor("importing scan '" + o.import.scan + "'", [&] { return cli::import(o.import); });
}

int printKeys(Options& o) {
  std::cout << (o.keys_of == "device"     ? deviceKeysTable()
                : o.keys_of == "task"     ? taskKeysTable()
                : o.keys_of == "features" ? featuresTable()
                : o.keys_of == "tissues"  ? tissueTable()
                                          : sceneKeysTable());
  return 0;
}

/// Runs a command; if memory runs out, the error says what it was doing and to which scene.
template <int (*kCommand)(const cli::RunOptions&)>
int withScene(const char* doing, Options& o) {
  return memoryFor(doing + (" scene '" + o.run.scene + "'"), [&] { return kCommand(o.run); });
}

int runScene(Options& o) {
  if (*o.exports) o.run.exported = o.exported;
  return withScene<cli::run>("running", o);
}

/// The commands in the order of --help.
struct Command {
  CLI::App* (*add)(CLI::App&, Options&);
  int (*run)(Options&);
};
constexpr Command kCommands[] = {
    {addCheck, [](Options& o) { return cli::check(o.device, o.run); }},
    {addRun, runScene},
    {addReplay,
     [](Options& o) { return memoryFor("replaying '" + o.replay.file + "'", [&] { return cli::replay(o.replay); }); }},
    {addTask,
     [](Options& o) { return memoryFor("judging task '" + o.run.task + "'", [&] { return cli::task(o.run); }); }},
    {addReport, [](Options& o) { return cli::report(o.report); }},
    {addSettle, [](Options& o) { return withScene<cli::settle>("settling", o); }},
    {addFit, [](Options& o) { return withScene<cli::fit>("fitting", o); }},
    {addAnchor, [](Options& o) { return withScene<cli::anchor>("anchoring in", o); }},
    {addSweep, [](Options& o) { return cli::sweep(o.sweep); }},
    {addImport, importScan},
    {addBench, [](Options&) { return 0; }},
    {addKeys, printKeys},
    {addUpgrade, [](Options& o) { return cli::upgrade(o.upgraded); }},
};

int dispatch(int argc, char** argv) {
  CLI::App app("viscera: soft-tissue surgical simulator");
  app.set_version_flag("--version", "viscera " VISCERA_VERSION);
  app.require_subcommand(1);
  Options options;
  std::vector<CLI::App*> added;
  for (const Command& command : kCommands) added.push_back(command.add(app, options));
  if (const std::optional<int> ended = cli::parse(app, argc, argv)) return *ended;
  const auto wanted = std::find_if(added.begin(), added.end(), [](const CLI::App* one) { return one->parsed(); });
  return kCommands[wanted - added.begin()].run(options);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const bool measures = argc > 1 && std::string(argv[1]) == "bench";
    return measures ? cli::bench(argv + 1) : dispatch(argc, argv);
  } catch (const std::exception& e) {
    return cli::giveUp(e);
  }
}
