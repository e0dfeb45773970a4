// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "export/exporter.h"
#include "model/scan/labels.h"
#include "model/scan/window.h"

namespace viscera::cli {

struct RunOptions {
  std::string scene;
  std::string mesh;     ///< empty: what the scene says
  std::string strokes;  ///< empty: nothing touches the tissue
  std::string task;     ///< file of a task that is judged, or the name of a shipped one; empty: none
  std::optional<double> seconds;
  std::string out;                        ///< empty: no pictures, no metrics.json
  bool no_view = false;                   ///< without OpenGL: on the processor, no pictures
  bool live = false;                      ///< pictures may be left out where drawing falls behind, but for marks
  bool depth = false;                     ///< depths are taken with every picture
  bool labels = false;                    ///< labels are
  std::string save, resume;               ///< files of a saved state; empty: none
  std::string record;                     ///< file in which all of it is recorded; empty: none
  double save_every_s = 0;                ///< simulated; 0: at the end only
  std::optional<ExportOptions> exported;  ///< into `out`/export
  Overrides overrides;
};
/// `viscera check`: EGL devices, which is taken, why others were not; with a scene, its bodies and their walls.
int check(int device, const RunOptions& options);

/// `viscera run`: a session without ROS.
int run(const RunOptions& options);

/// `viscera task`: a session in the scene of options.task, judged; docs/lessons/tasks.md.
int task(RunOptions options);

struct ReplayOptions {
  std::string file;
  double from_s = 0;  ///< steps after this are looked at
  std::optional<double> until_s;
  double speed = 0;  ///< of the clock; 0: as fast as can be
  std::string out;   ///< empty: no pictures, no tables
  std::string save;  ///< file for the state at the end; empty: none
  bool no_view = false, depth = false, labels = false;
  Overrides overrides;  ///< of keys that change no state
};
/// `viscera replay`: a recorded session again. @return 1 if its states are not those that were recorded
int replay(const ReplayOptions& options);

/// `viscera bench`: runs the program viscera-bench that stands beside this one. @param arguments  of the command line,
/// from "bench" on, ended by null   @throws Error  it is not there   @return only if it could not be started
int bench(char** arguments);

/// `viscera settle`: the static state of a scene, and what it took.
int settle(const RunOptions& options);

struct SweepOptions {
  std::string plan;  ///< file (sweep_plan.h)
  std::string out;
  int jobs = 0;             ///< sessions side by side; 0: as many as the machine has threads
  int tries = 2;            ///< failures after which a run is given up
  int run_limit_s = 86400;  ///< a run that takes longer is killed, and has failed; 0: no limit
  bool retry = false;
  int slurm = 0;       ///< > 0: submit a job array of so many workers instead
  std::string sbatch;  ///< more options for sbatch, as one would write them in a shell
};
/// `viscera sweep`: many sessions, by any number of processes that share a folder. @return 1 if some were given up
int sweep(const SweepOptions& options);

/// `viscera fit`: a scene with another organ, as a file that one can edit.
int fit(const RunOptions& options);

/// `viscera anchor`: anchored strokes as absolute ones.
int anchor(const RunOptions& options);

struct ImportOptions {
  std::string scan;
  LabelOptions labels;     ///< with what the file cannot say
  bool by_window = false;  ///< tissue is what lies within `window`, not labels
  WindowOptions window;
  double spacing_m = 0;            ///< 0: the largest organ gets some 20,000 nodes
  bool one_body = false;           ///< all labels are parts of one body
  std::vector<std::string> rigid;  ///< numbers or names of labels that are held in space
  bool list = false;               ///< says what is in the scan, and writes nothing
  bool no_previews = false;
  bool smooth = false;  ///< a label map that was made finer is read as it was before
  std::string grey;     ///< scan that labels were drawn on, for previews; empty: not known
  std::string out;
};
/// `viscera import`: organs of a scan as meshes and a scene of them.
int import(const ImportOptions& options);

}  // namespace viscera::cli
