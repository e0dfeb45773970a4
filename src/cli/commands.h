// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/film/film_options.h"
#include "cli/page/page_options.h"
#include "export/exporter.h"
#include "model/scan/labels.h"
#include "model/scan/window.h"

namespace viscera::cli {

struct RunOptions {
  std::string scene;
  std::string mesh;                 ///< mesh file; empty: the scene's
  std::string strokes;              ///< strokes file; empty: nothing touches the tissue
  std::string task;                 ///< file or shipped name of a task to judge; empty: none
  std::optional<std::string> name;  ///< trainee's name in the report of the task
  std::optional<double> seconds;
  std::string out;                        ///< output folder; empty: no images, no metrics.json
  bool no_view = false;                   ///< whether to run without OpenGL: on the CPU, without images
  bool live = false;                      ///< whether to skip images if drawing falls behind, except those of marks
  bool depth = false;                     ///< whether to write depth with every image
  bool labels = false;                    ///< whether to write labels with every image
  std::string save, resume;               ///< files of saved states; empty: none
  std::string record;                     ///< file of a recording; empty: none
  double save_every_s = 0;                ///< simulated time between saved states [s]; 0: at the end only
  std::optional<ExportOptions> exported;  ///< options of the export into `out`/export
  FilmOptions film;
  PageOptions page;
  Overrides overrides;
};
/// Runs `viscera check`: lists EGL devices, the chosen one, and why others were not chosen; for a scene, its bodies and
/// walls.
int check(int device, const RunOptions& options);

/// Runs `viscera run`: a session without ROS.
int run(const RunOptions& options);

/// Runs `viscera task`: a judged session in the scene of options.task; docs/lessons/tasks.md.
int task(RunOptions options);

struct ReplayOptions {
  std::string file;
  double from_s = 0;  ///< time from which steps are shown [s]
  std::optional<double> until_s;
  double speed = 0;  ///< speed relative to the clock; 0: as fast as possible
  std::string out;   ///< output folder; empty: no images, no tables
  std::string save;  ///< file of the final state; empty: none
  FilmOptions film;
  PageOptions page;
  bool no_view = false, depth = false, labels = false;
  std::optional<std::string> name;  ///< trainee's name in reports of tasks
  Overrides overrides;              ///< overrides of keys that do not affect the state
};
/// Runs `viscera replay`: repeats a recorded session. @return 1 if its states differ from the recorded ones
int replay(const ReplayOptions& options);

struct ReportOptions {
  std::string folder;  ///< searched for files report.json, with its subfolders
  std::string out;     ///< page to write; empty: progress.html in the folder
};
/// Runs `viscera report`: a page with the progress of trainees over all reports in a folder.
/// @throws Error  the folder cannot be read, has no report, or the page cannot be written
int report(ReportOptions options);

/// Runs `viscera bench`: starts the program viscera-bench in the folder of this one.
/// @param arguments  command line from "bench" on, null-terminated
/// @throws Error  it does not exist   @return only if it could not be started
int bench(char** arguments);

/// Runs `viscera settle`: computes the static state of a scene, and prints the effort.
int settle(const RunOptions& options);

struct SweepOptions {
  std::string plan;  ///< file of the plan (sweep_plan.h)
  std::string out;
  int jobs = 0;             ///< number of concurrent sessions; 0: number of hardware threads
  int tries = 2;            ///< number of failures after which a run is given up
  int run_limit_s = 86400;  ///< time limit of a run [s], after which it is killed and has failed; 0: no limit
  bool retry = false;
  int slurm = 0;       ///< number of workers; > 0: submits a job array of workers instead
  std::string sbatch;  ///< further options for sbatch, in shell syntax
};
/// Runs `viscera sweep`: many sessions, by any number of processes that share a folder. @return 1 if some were given up
int sweep(const SweepOptions& options);

/// Runs `viscera fit`: writes a scene with another organ, as an editable file.
int fit(const RunOptions& options);

/// Runs `viscera anchor`: converts anchored strokes to absolute ones.
int anchor(const RunOptions& options);

/// Runs `viscera upgrade`: renames the keys of scene, strokes, task and sweep files to those of this version, in place.
int upgrade(const std::vector<std::string>& files);

struct ImportOptions {
  std::string scan;
  LabelOptions labels;     ///< options for what the file does not specify
  bool by_window = false;  ///< whether `window` selects tissue, instead of labels
  WindowOptions window;
  double spacing_m = 0;            ///< lattice spacing [m]; 0: about 20,000 nodes in the largest organ
  bool one_body = false;           ///< whether all labels are parts of one body
  std::vector<std::string> rigid;  ///< numbers or names of labels that are fixed in space
  bool list = false;               ///< whether to list the contents of the scan and write nothing
  bool no_previews = false;
  bool smooth = false;  ///< whether to undo the upsampling of a label map
  std::string grey;     ///< scan on which the labels were drawn, for previews; empty: not known
  std::string out;
};
/// Runs `viscera import`: converts organs of a scan to meshes and a scene.
int import(const ImportOptions& options);

}  // namespace viscera::cli
