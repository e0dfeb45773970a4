// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <map>

#include "cli/commands.h"
#include "cli/fault.h"
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
  cli::SweepOptions sweep;
  cli::ImportOptions import;
  ExportOptions exported;
  CLI::Option* exports = nullptr;  // run --export
  std::string keys_of;
  std::vector<double> window;  // of import; empty: none was given
};

CLI::Option* addOverrides(CLI::App* command, Overrides& overrides) {
  return command
      ->add_option("--set", overrides, "key=value: replaces one value of the scene, as in bodies[0].spacing_m=0.003")
      ->allow_extra_args(false);
}

CLI::App* addCheck(CLI::App& app, Options& o) {
  CLI::App* check = app.add_subcommand(
      "check", "list the EGL devices and say which is taken, and why others are not; or measure the walls of a scene");
  CLI::Option* device = check->add_option("--device", o.device, "take only this device");
  CLI::Option* scene = check->add_option("scene", o.run.scene,
                                         "print thickness of its walls in cells, and what error to expect of them");
  scene->excludes(device);
  addOverrides(check, o.run.overrides)->needs(scene);
  return check;
}

/// Adds what `run` exports. @param out  its option --out
void addExports(CLI::App* run, CLI::Option* out, Options& o) {
  const std::map<std::string, ExportSource> sources = {{"skin", ExportSource::kSkin},
                                                       {"lattice", ExportSource::kLattice},
                                                       {"network", ExportSource::kNetwork},
                                                       {"threads", ExportSource::kThreads}};
  const std::map<std::string, ExportFormat> formats = {{"vtp", ExportFormat::kVtp},
                                                       {"xdmf", ExportFormat::kXdmf},
                                                       {"ply", ExportFormat::kPly},
                                                       {"glb", ExportFormat::kGlb},
                                                       {"pc2", ExportFormat::kPc2}};
  const std::map<std::string, ExportFrame> frames = {{"ros", ExportFrame::kRos}, {"lps_mm", ExportFrame::kLpsMm}};
  CLI::Option* exported = o.exports =
      run->add_option("--export", o.exported.source, "skin, lattice, network or threads into DIR/export")
          ->transform(CLI::CheckedTransformer(sources))
          ->needs(out);
  run->add_option("--every", o.exported.every_s, "simulated seconds between two exports; default 0.1")
      ->check(CLI::Range(1e-6, 86400.0))
      ->needs(exported);
  run->add_option("--format", o.exported.format, "of exports: vtp, xdmf, ply, glb or pc2; default vtp")
      ->transform(CLI::CheckedTransformer(formats))
      ->needs(exported);
  run->add_option("--export-frame", o.exported.frame, "axes and unit of exports: ros, or lps_mm as 3D Slicer has them")
      ->transform(CLI::CheckedTransformer(frames))
      ->needs(exported);
}

/// Options that `run` had and --help no longer lists: what to type instead.
void addMoved(CLI::App* run) {
  for (const std::string option : {"--reference", "--compare"}) {
    run->add_flag_callback(option,
                           [option] {
                             throw cli::CommandLineError(
                                 "command line: run has no option " + option +
                                     ": type `viscera bench reference SCENE [--compare]` instead",
                                 static_cast<int>(CLI::ExitCodes::ExtrasError));
                           })
        ->group("");
  }
}

CLI::App* addRun(CLI::App& app, Options& o) {
  CLI::App* run = app.add_subcommand("run", "run a scene without ROS; the last line is one JSON object");
  run->add_option("scene", o.run.scene, "scene file, or name of a shipped scene")->required();
  run->add_option("--mesh", o.run.mesh, "mesh file that becomes the first body");
  run->add_option("--strokes", o.run.strokes, "recorded strokes to replay");
  run->add_option("--seconds", o.run.seconds, "simulated time; default: the strokes' length, or 1")
      ->check(CLI::Range(0.0, 86400.0));
  CLI::Option* out = run->add_option(
      "--out", o.run.out, "folder for pictures, metrics.json and surface.ply, the skin at the end; an older run's go");
  run->add_flag("--live", o.run.live,
                "leave pictures out rather than wait for them, as a live session does; but for marks")
      ->needs(out);
  run->add_flag("--depth", o.run.depth,
                "depths with every picture: .npy, float32, metres along the optical axis, +Inf where nothing is")
      ->needs(out);
  run->add_flag("--labels", o.run.labels, "what each pixel shows with every picture: grey .png (docs/ros_api.md)")
      ->needs(out);
  addExports(run, out, o);
  CLI::Option* save =
      run->add_option("--save", o.run.save, "file for the state at the end, to go on from with --resume");
  run->add_option("--save-every", o.run.save_every_s,
                  "simulated seconds after which the state is saved, again and again")
      ->check(CLI::Range(1e-6, 86400.0))
      ->needs(save);
  run->add_option("--record", o.run.record, "new file in which all of it is recorded, for viscera replay");
  run->add_option("--resume", o.run.resume,
                  "state that this scene was saved in: goes on there, to the same end in time");
  run->add_flag("--no-view", o.run.no_view,
                "without pictures, and without OpenGL unless solver.backend: gpu asks for it");
  addOverrides(run, o.run.overrides);
  addMoved(run);
  return run;
}

CLI::App* addReplay(CLI::App& app, Options& options) {
  cli::ReplayOptions& o = options.replay;
  CLI::App* replay = app.add_subcommand("replay", "a recorded session again; the last line is one JSON object");
  replay->add_option("file", o.file, "recording, of `viscera run --record` or the simulator")->required();
  const CLI::Range seconds(0.0, 1e6);
  replay->add_option("--from", o.from_s, "seconds of the recording that are passed over")->check(seconds);
  replay->add_option("--until", o.until_s, "seconds of the recording at which it ends")->check(seconds);
  replay->add_option("--speed", o.speed, "times as fast as it was; default: as fast as can be")
      ->check(CLI::Range(1e-3, 1e3));
  CLI::Option* out = replay->add_option(
      "--out", o.out, "folder for pictures, metrics.json, hands.csv and surface.ply; an older run's go");
  replay->add_flag("--depth", o.depth, "depths with every picture, as of run")->needs(out);
  replay->add_flag("--labels", o.labels, "labels with every picture, as of run")->needs(out);
  replay->add_flag("--no-view", o.no_view,
                   "without pictures, and without OpenGL unless solver.backend: gpu asks for it");
  replay->add_option("--save", o.save, "file for the state at the end, to go on from with run --resume");
  replay
      ->add_option("--set", o.overrides,
                   "key=value: another value of the scene, of what changes no state, as in cameras[0].position_m")
      ->allow_extra_args(false);
  return replay;
}

CLI::App* addTask(CLI::App& app, Options& o) {
  CLI::App* task =
      app.add_subcommand("task", "judge a hand in a task (docs/lessons/tasks.md); the last line is one JSON object");
  task->add_option("task", o.run.task, "task file, or name of a shipped task")->required();
  task->add_option("--strokes", o.run.strokes, "recorded strokes of the hand");
  task->add_option("--seconds", o.run.seconds, "simulated time; default: the strokes' length, or 1")
      ->check(CLI::Range(0.0, 86400.0));
  task->add_option("--out", o.run.out, "folder for pictures and tables as of run, and the report");
  task->add_flag("--no-view", o.run.no_view,
                 "without pictures, and without OpenGL unless solver.backend: gpu asks for it");
  task->add_option("--record", o.run.record, "new file in which all of it is recorded, for viscera replay");
  addOverrides(task, o.run.overrides);
  return task;
}

CLI::App* addSettle(CLI::App& app, Options& o) {
  CLI::App* settle =
      app.add_subcommand("settle", "find the state in which a scene hangs in its weight; one JSON object");
  settle->add_option("scene", o.run.scene, "scene file, or name of a shipped scene")->required();
  settle->add_option("--mesh", o.run.mesh, "mesh file that becomes the first body");
  addOverrides(settle, o.run.overrides);
  return settle;
}

CLI::App* addFit(CLI::App& app, Options& o) {
  CLI::App* fit = app.add_subcommand("fit", "write a scene with another organ, which all in it follows, to edit");
  fit->add_option("scene", o.run.scene, "scene file, or name of a shipped scene")->required();
  fit->add_option("--mesh", o.run.mesh, "mesh file that becomes the first body")->required();
  fit->add_option("--out", o.run.out, "scene file to write")->required();
  addOverrides(fit, o.run.overrides);
  return fit;
}

CLI::App* addAnchor(CLI::App& app, Options& o) {
  CLI::App* anchor = app.add_subcommand("anchor", "write strokes anchored to the skin as absolute ones");
  anchor->add_option("scene", o.run.scene, "scene file, or name of a shipped scene")->required();
  anchor->add_option("--strokes", o.run.strokes, "strokes file with anchors")->required();
  anchor->add_option("--mesh", o.run.mesh, "mesh file that becomes the first body");
  anchor->add_option("--out", o.run.out, "strokes file to write")->required();
  addOverrides(anchor, o.run.overrides);
  return anchor;
}

CLI::App* addImport(CLI::App& app, Options& options) {
  cli::ImportOptions& o = options.import;
  CLI::App* import = app.add_subcommand("import", "make a scene of a scan's organs (docs/scans.md)");
  import->add_option("scan", o.scan, "NIfTI, NRRD, MetaImage or DICOM file, or folder of DICOM files")->required();
  CLI::Option* list = import->add_flag("--list", o.list, "say what is in the scan, and write nothing");
  CLI::Option* labels =
      import->add_option("--labels", o.labels.labels, "numbers or names, a comma between; default: all")
          ->delimiter(',');
  CLI::Option* values = import
                            ->add_option("--window", options.window,
                                         "LO,HI: values that are taken for tissue; of CT in "
                                         "Hounsfield units. That is no segmentation")
                            ->delimiter(',')
                            ->expected(2)
                            ->excludes(labels);
  import->add_option("--closing-mm", o.window.closing_mm, "gaps narrower than twice that close; 0 .. 20; default 0")
      ->check(CLI::Range(0.0, 20.0))
      ->needs(values);
  import->add_option("--pieces", o.window.pieces, "so many of the largest pieces; default 1; 0: all")
      ->check(CLI::Range(0, 1'000'000))
      ->needs(values);
  import->add_flag("--fill-holes", o.window.fill_holes, "what tissue encloses is tissue")->needs(values);
  import->add_option("--spacing", o.spacing_m, "of all lattices [m]; default: some 20,000 nodes for the largest organ")
      ->check(CLI::Range(1e-5, 10.0));
  import->add_flag("--one-body", o.one_body, "labels are parts of one body, of the scan itself: none slides")
      ->excludes(values);
  import->add_option("--rigid", o.rigid, "labels that are held in space, as bone; a comma between")
      ->delimiter(',')
      ->excludes(values);
  import->add_option("--names", o.labels.names_file, "table of names, of ITK-SNAP or YAML");
  import->add_option("--axes", o.labels.axes, "where i, j, k lead to, where the file does not say, as in LPS");
  import->add_option("--transform", o.labels.transform, "sform or qform, where a NIfTI file has two that differ");
  import->add_option("--volume", o.labels.volume, "0 and up, of a file with several")->check(CLI::Range(0, 1'000'000));
  import->add_option("--series", o.labels.series, "number or UID of a DICOM series; all: they are one volume");
  import->add_flag("--fill-slices", o.labels.fill_slices, "missing slices of DICOM are like the nearest")
      ->excludes("--one-body");
  import->add_option("--grey", o.grey, "scan that the labels were drawn on, for the previews")->excludes(values);
  import->add_flag("--smooth", o.smooth, "read a label map that was made finer, voxel by voxel, as it was before")
      ->excludes(values)
      ->excludes("--one-body");
  import->add_flag("--no-previews", o.no_previews, "no pictures of organs and slices");
  import->add_option("--out", o.out, "new folder for scene.yaml and its meshes")->excludes(list);
  return import;
}

CLI::App* addSweep(CLI::App& app, Options& o) {
  CLI::App* sweep = app.add_subcommand("sweep", "run many sessions that differ in scene keys; one table");
  sweep->add_option("plan", o.sweep.plan, "file with the runs (docs/cluster.md)")->required();
  sweep->add_option("--out", o.sweep.out, "folder for results.csv and the runs; processes that share it share the runs")
      ->required();
  sweep->add_option("--jobs", o.sweep.jobs, "sessions side by side; 0, the default: one per processor that may be used")
      ->check(CLI::Range(0, 1024));
  sweep->add_option("--tries", o.sweep.tries, "failures after which a run is given up; default 2")
      ->check(CLI::Range(1, 100));
  sweep
      ->add_option("--run-limit-s", o.sweep.run_limit_s,
                   "seconds after which a run is killed and has failed; default 86400, a day; 0: never")
      ->check(CLI::Range(0, 100'000'000));
  CLI::Option* slurm = sweep->add_option("--slurm", o.sweep.slurm, "submit a job array of so many workers to Slurm")
                           ->check(CLI::Range(1, 100000));
  sweep->add_option("--sbatch", o.sweep.sbatch, "more options for Slurm's sbatch, as in '--cpus-per-task=8 --time=60'")
      ->needs(slurm);
  sweep->add_flag("--retry", o.sweep.retry, "try again what was given up");
  return sweep;
}

/// Stands in the list of commands; main() has taken its options.
CLI::App* addBench(CLI::App& app, Options&) {
  return app.add_subcommand("bench", "measure: `viscera bench --help` lists what");
}

CLI::App* addKeys(CLI::App& app, Options& o) {
  CLI::App* keys = app.add_subcommand("keys", "print the table of a file's keys, or of tissues");
  keys->add_option(
          "file", o.keys_of,
          "scene, device: of config/devices, task: of config/tasks, features: what goes with what, or tissues: what "
          "material.tissue may name; default scene")
      ->check(CLI::IsMember({"scene", "device", "task", "features", "tissues"}));
  return keys;
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

/// Makes a command that says what it was doing to which scene where memory does not suffice.
template <int (*kCommand)(const cli::RunOptions&)>
int withScene(const char* doing, Options& o) {
  return memoryFor(doing + (" scene '" + o.run.scene + "'"), [&] { return kCommand(o.run); });
}

int runScene(Options& o) {
  if (*o.exports) o.run.exported = o.exported;
  return withScene<cli::run>("running", o);
}

/// The commands in the order in which --help lists them.
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
    {addSettle, [](Options& o) { return withScene<cli::settle>("settling", o); }},
    {addFit, [](Options& o) { return withScene<cli::fit>("fitting", o); }},
    {addAnchor, [](Options& o) { return withScene<cli::anchor>("anchoring in", o); }},
    {addSweep, [](Options& o) { return cli::sweep(o.sweep); }},
    {addImport, importScan},
    {addBench, [](Options&) { return 0; }},
    {addKeys, printKeys},
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
