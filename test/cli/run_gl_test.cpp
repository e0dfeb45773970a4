// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/small_scene.h"
#include "support/source_folder.h"
#include "support/text.h"
#include "viscera/model/scene/scene.h"
#include "viscera/model/shape/mesh_import.h"

namespace viscera {
namespace {

using namespace test;
using Json = nlohmann::json;
namespace fs = std::filesystem;

/// A cut through the block, which begins when the stylus is already next to it, and a moment for an image.
constexpr const char* kRunCut =
    "strokes:\n"
    "  - stylus: left\n"
    "    anchor: {from_m: [0.001, -0.3, 0.001], towards_m: [0.001, 0, 0.001]}\n"
    "    keys:\n"
    "      - {t_s: 0, position_m: [-0.03, 0, -0.015], button2: true}\n"
    "      - {t_s: 0.15, position_m: [0.03, 0, -0.015], button2: true}\n"
    "marks: [{name: half way, t_s: 0.1}]\n";

class Run : public ::testing::Test {
 protected:
  /// Returns the JSON object in the last line of standard output.
  static Json metricsOf(const Ending& ending) {
    EXPECT_EQ(ending.status, 0) << ending.err;
    const std::vector<std::string> lines = linesOf(ending.out);
    return lines.empty() ? Json() : Json::parse(lines.back(), nullptr, false);
  }
  Ending run(std::vector<std::string> options) const {
    options.insert(options.begin(), {"run", scene_});
    return viscera(options);
  }

  TemporaryFolder folder_;
  std::string scene_ = folder_.write("block.yaml", kBlockScene), strokes_ = folder_.write("cut.yaml", kRunCut);
};

uint32_t bigEndian(const std::string& bytes, size_t at) {
  uint32_t value = 0;
  for (size_t i = at; i < at + 4; ++i) value = value << 8 | static_cast<uint8_t>(bytes.at(i));
  return value;
}

void expectPng(const std::string& path, uint32_t width, uint32_t height) {
  const std::string bytes = readFile(path);
  ASSERT_GT(bytes.size(), 24u) << path;
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n") << path;
  EXPECT_EQ(bigEndian(bytes, 16), width) << path;
  EXPECT_EQ(bigEndian(bytes, 20), height) << path;
}

/// Kernels read by texel fetches on software renderers and by loads on GPUs.
TEST_F(Run, KernelsThatReadByLoadsAndByTexelsComeToTheSameState) {
  const auto with = [&](const std::string& reads) {
    return viscera({"run", scene_, "--strokes", strokes_, "--no-view", "--set", "solver.backend=gpu"},
                   {"VISCERA_READS=" + reads});
  };
  const Json loads = metricsOf(with("loads")), texels = metricsOf(with("texels"));
  EXPECT_EQ(loads["backend"], "gpu");
  EXPECT_GT(loads["springs_cut"], 0);
  EXPECT_EQ(loads["state_hash"], texels["state_hash"]);
  const Ending other = with("rows");
  EXPECT_NE(other.status, 0);
  EXPECT_NE(other.err.find("VISCERA_READS is 'rows' and must be loads or texels"), std::string::npos) << other.err;
}

TEST_F(Run, EveryIntegratorBringsTheHangingBlockToTheSameSag) {
  // With this much drag the block does not swing beyond its sag, which implicit Euler would damp.
  constexpr double kApart = 1e-3;  // relative to the sag: remaining distance to it, and float32
  const auto stretch = [&](const std::string& integrator, const std::string& backend) {
    const Json metrics =
        metricsOf(run({"--seconds", "0.5", "--set", "bodies[0].material.mass_damping_per_s=500", "--set",
                       "bodies[0].material.law=springs", "--set", "solver.integrator=" + integrator, "--set",
                       "solver.substeps=40", "--set", "solver.backend=" + backend}));
    EXPECT_EQ(metrics["roll_backs"], 0) << integrator;
    return metrics["max_stretch"].get<double>();
  };
  const double sag = stretch("leapfrog", "gpu");
  EXPECT_GT(sag, 0);
  for (const auto& [integrator, backend] :
       {std::pair("pd", "gpu"), std::pair("leapfrog", "cpu"), std::pair("pd", "cpu")})
    EXPECT_NEAR(stretch(integrator, backend), sag, kApart * sag) << integrator << ", " << backend;
}

TEST_F(Run, EquilibriumIsWhereTheBlockHangsFromTheFirstTickOn) {
  constexpr double kApart = 1e-3;  // relative to the sag, as above
  const Json settled = metricsOf(viscera({"settle", scene_, "--set", "bodies[0].material.law=springs"}));
  EXPECT_EQ(settled["settled"], true);
  EXPECT_GT(settled["substeps"], 0);
  EXPECT_GT(settled["max_displacement_m"], 0);
  const Json sagged =
      metricsOf(run({"--seconds", "0.5", "--no-view", "--set", "bodies[0].material.mass_damping_per_s=500", "--set",
                     "bodies[0].material.law=springs"}));
  for (const char* integrator : {"leapfrog", "pd"}) {
    const Json metrics =
        metricsOf(run({"--seconds", "0.05", "--no-view", "--set", "solver.start=equilibrium", "--set",
                       "bodies[0].material.law=springs", "--set", std::string("solver.integrator=") + integrator}));
    EXPECT_NEAR(metrics["max_stretch"], sagged["max_stretch"].get<double>(),
                kApart * sagged["max_stretch"].get<double>())
        << integrator;
  }
}

TEST_F(Run, MaterialOfAPartAndPoissonsRatioReachTheTissue) {
  const auto metrics = [&](const std::string& change) {
    return metricsOf(run({"--seconds", "0.5", "--set", "bodies[0].material.mass_damping_per_s=700", "--set", change}));
  };
  const Json plain = metrics("bodies[0].material.poisson_ratio=0.25");
  const Json stiff = metrics("bodies[0].parts=[{part: box, young_modulus_pa: 80000}]");
  const Json full = metrics("bodies[0].material.poisson_ratio=0.45");
  EXPECT_NEAR(stiff["max_stretch"].get<double>(), 0.25 * plain["max_stretch"].get<double>(),
              0.02 * plain["max_stretch"].get<double>());  // a quarter of the sag; the drag suppresses oscillations
  EXPECT_NEAR(stiff["dt_safe_s"].get<double>(), 0.5 * plain["dt_safe_s"].get<double>(), 1e-8);
  EXPECT_LT(full["dt_safe_s"], 0.6 * plain["dt_safe_s"].get<double>());
  EXPECT_NE(full["state_hash"], plain["state_hash"]);
}

/// A sheet of nodes with a contact distance of 0.2 m: one cell of the contact search contains them all.
TEST_F(Run, NodesTooCrowdedForContactsAreCounted) {
  const std::string sheet = folder_.write("crowd.yaml",
                                          "name: crowd\n"
                                          "bodies:\n"
                                          "  - {name: sheet, source: sheet, structure: surface, spacing_m: 0.001,\n"
                                          "     box_size_m: [0.07, 0.07, 0.001], position_m: [0.1, 0.1, 0.1]}\n"
                                          "collision: {enabled: true}\n"
                                          "solver: {tick_hz: 1000}\n");  // few substeps
  for (const std::string backend : {"gpu", "cpu"}) {
    const auto crowded = [&](const std::string& distance_m) {
      return metricsOf(viscera({"run", sheet, "--seconds", "0.002", "--set", "solver.backend=" + backend, "--set",
                                "collision.distance_m=" + distance_m}));
    };
    const Json close = crowded("0.2");
    EXPECT_EQ(close["nodes_crowded"], close["nodes"]) << backend;
    EXPECT_EQ(crowded("0.001")["nodes_crowded"], 0) << backend;
  }
}

TEST_F(Run, LastLineIsAnObjectWithAllMeasurements) {
  const Json metrics = metricsOf(run({"--seconds", "0.1"}));
  ASSERT_TRUE(metrics.is_object());
  for (const char* key : {"nodes", "springs", "springs_cut", "faces", "steps", "dt_s", "dt_safe_s", "dt_limit_s",
                          "real_time_factor", "node_updates_per_s", "max_stretch", "nonfinite", "nodes_crowded",
                          "roll_backs", "ticks_speed_limited", "peak_force_n"}) {
    ASSERT_TRUE(metrics.contains(key)) << key;
    EXPECT_TRUE(metrics[key].is_number()) << key;
  }
  EXPECT_EQ(metrics["nodes"], 125);
  EXPECT_EQ(metrics["springs"], 3 * 4 * 25 + 2 * 3 * 16 * 5);  // edges and the diagonals of all faces of 64 cells
  EXPECT_EQ(metrics["springs_cut"], 0);
  EXPECT_GT(metrics["faces"], 0);
  EXPECT_GT(metrics["dt_s"].get<double>(), SolverConfig{}.dt_fraction * metrics["dt_safe_s"].get<double>());
  EXPECT_LT(metrics["dt_s"], metrics["dt_limit_s"]);
  EXPECT_GE(metrics["steps"].get<double>() * metrics["dt_s"].get<double>(), 0.1 - 1e-9);  // shorter ones under strain
  EXPECT_GT(metrics["max_stretch"], 0);                                                   // it hangs
  EXPECT_EQ(metrics["nonfinite"], 0);
  EXPECT_EQ(metrics["peak_force_n"], 0);
  EXPECT_EQ(metrics["state_hash"].get<std::string>().find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_EQ(metrics["state_hash"].get<std::string>().size(), 16u);
  EXPECT_FALSE(metrics["renderer"].get<std::string>().empty());
}

TEST_F(Run, SameCommandGivesTheSameStateAndAnotherOneAnotherOnEveryBackend) {
  for (const std::string backend : {"gpu", "cpu"}) {
    SCOPED_TRACE(backend);
    const auto hashOf = [&](const std::string& seconds) {
      return metricsOf(
                 run({"--seconds", seconds, "--strokes", strokes_, "--set", "solver.backend=" + backend}))["state_hash"]
          .get<std::string>();
    };
    const std::string hash = hashOf("0.2");
    EXPECT_EQ(hashOf("0.2"), hash);
    EXPECT_NE(hashOf("0.1"), hash);
  }
}

TEST_F(Run, BackendThatTheSceneAsksForIsTakenAndNamed) {
  const auto metrics = [&](const std::vector<std::string>& set) {
    std::vector<std::string> options = {"--strokes", strokes_};
    for (const std::string& change : set) options.insert(options.end(), {"--set", change});
    return metricsOf(run(options));
  };
  // With substeps that do not depend on the strain, which a GPU reports later.
  const Json gpu = metrics({"solver.backend=gpu", "solver.substeps=20"});
  const Json cpu = metrics({"solver.backend=cpu", "solver.substeps=20"});
  EXPECT_EQ(gpu["backend"], "gpu");
  EXPECT_EQ(cpu["backend"].get<std::string>().rfind("cpu (", 0), 0u) << cpu["backend"];
  // The tissue is the same, so results differ by rounding only.
  EXPECT_EQ(cpu["springs_cut"], gpu["springs_cut"]);
  EXPECT_NEAR(cpu["max_stretch"].get<double>(), gpu["max_stretch"].get<double>(),
              1e-3 * gpu["max_stretch"].get<double>());
  const Json alone = metrics({"solver.backend=cpu", "solver.threads=1", "solver.substeps=20"});
  EXPECT_NE(alone["backend"].get<std::string>().find(", 1 thread)"), std::string::npos) << alone["backend"];
  EXPECT_EQ(alone["state_hash"], cpu["state_hash"]);
  const std::string chosen = metrics({})["backend"];
  EXPECT_TRUE(chosen == gpu["backend"] || chosen == cpu["backend"]) << chosen;
}

TEST_F(Run, StrokesActOnTheTissueAndSayHowLongToRun) {
  const Json metrics = metricsOf(run({"--strokes", strokes_}));
  EXPECT_GT(metrics["springs_cut"], 0);
  EXPECT_GE(metrics["steps"].get<double>() * metrics["dt_s"].get<double>(), 0.15 - 1e-9);
}

TEST_F(Run, PicturesAndMetricsGoToTheFolder) {
  const std::string out = folder_.file("a/new/folder");
  const Ending ending = run({"--strokes", strokes_, "--seconds", "0.2", "--out", out});
  const Json metrics = metricsOf(ending);
  EXPECT_EQ(Json::parse(readFile(out + "/metrics.json"), nullptr, false), metrics);
  std::set<std::string> pictures;
  for (const auto& entry : fs::directory_iterator(out + "/frames")) pictures.insert(entry.path().filename().string());
  EXPECT_EQ(pictures, (std::set<std::string>{"eye_000002.png", "eye_000004.png", "eye_000006.png", "eye_000008.png",
                                             "eye_000010.png", "eye_000012.png"}));  // 30 Hz at 60 ticks per second
  for (const std::string& picture : pictures) expectPng(out + "/frames/" + picture, 64, 48);
  expectPng(out + "/half way_eye.png", 64, 48);
  EXPECT_EQ(readFile(out + "/half way_eye.png"), readFile(out + "/frames/eye_000006.png"));
  EXPECT_NE(readFile(out + "/frames/eye_000002.png"), readFile(out + "/frames/eye_000012.png"));
}

TEST_F(Run, DepthsLabelsAndRightEyesGoBesideThePictures) {
  const std::string out = folder_.file("depths");
  metricsOf(
      run({"--seconds", "0.05", "--out", out, "--depth", "--labels", "--set", "cameras[0].stereo_baseline_m=0.005"}));
  expectPng(out + "/frames/eye_000002.png", 64, 48);
  expectPng(out + "/frames/eye_right_000002.png", 64, 48);
  EXPECT_NE(readFile(out + "/frames/eye_000002.png"), readFile(out + "/frames/eye_right_000002.png"));
  const std::string npy = readFile(out + "/frames/eye_depth_000002.npy");
  constexpr size_t kValues = 64 * 48 * sizeof(float);
  ASSERT_GT(npy.size(), kValues);
  EXPECT_EQ((npy.size() - kValues) % 64, 0U);  // offset of the values
  EXPECT_EQ(npy.substr(1, 5), "NUMPY");
  EXPECT_NE(npy.find("'<f4', 'fortran_order': False, 'shape': (48, 64)"), std::string::npos);
  float middle = 0;
  std::memcpy(&middle, &npy[npy.size() - kValues + sizeof(float) * (24 * 64 + 32)], sizeof middle);
  EXPECT_GT(middle, 0.05F);
  EXPECT_LT(middle, 1.0F);
  EXPECT_TRUE(fs::exists(out + "/frames/eye_labels_000002.png"));
}

TEST_F(Run, SkinAtTheEndGoesToTheFolderWithItsWounds) {
  const auto skinAfter = [&](std::vector<std::string> options) {
    const std::string out = folder_.file("skin_" + std::to_string(options.size()));
    options.insert(options.end(), {"--out", out, "--set", "environment.gravity_m_per_s2=[0, 0, 0]"});
    metricsOf(run(options));
    return importMesh(out + "/surface.ply", 1);
  };
  const TriangleMesh whole = skinAfter({"--seconds", "0.05", "--live"}), wounded = skinAfter({"--strokes", strokes_});
  Vector3f lowest = Vector3f::Zero(), highest = Vector3f::Zero();
  for (const Vector3f& p : whole.positions_m) {
    lowest = lowest.cwiseMin(p);
    highest = highest.cwiseMax(p);
  }
  EXPECT_LT((lowest - Vector3f::Constant(-0.02f)).norm(), 1e-6f);  // the block, without loads
  EXPECT_LT((highest - Vector3f::Constant(0.02f)).norm(), 1e-6f);
  EXPECT_GT(wounded.triangles.size(), whole.triangles.size());  // split along the cut, and with cut walls
  EXPECT_LT(wounded.triangles.size(), 2 * whole.triangles.size());
}

TEST_F(Run, WithoutAViewNoDeviceIsNeededAndTheStateIsTheSame) {
  const std::vector<std::string> cpu = {"--strokes", strokes_, "--set", "solver.backend=cpu"};
  const Json seen = metricsOf(run(cpu));
  std::vector<std::string> options = {"run", scene_, "--no-view", "--out", folder_.file("unseen")};
  options.insert(options.end(), cpu.begin(), cpu.end());
  const Json unseen = metricsOf(viscera(options, {kNoDevice}));
  EXPECT_EQ(unseen["state_hash"], seen["state_hash"]);
  EXPECT_EQ(unseen["springs_cut"], seen["springs_cut"]);
  EXPECT_EQ(unseen["renderer"], "none");
  EXPECT_EQ(unseen["images"], 0);
  std::set<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder_.file("unseen")))
    files.insert(entry.path().filename().string());
  EXPECT_EQ(files,
            (std::set<std::string>{".viscera_run", "tools.csv", "kinematics.txt", "metrics.json", "surface.ply"}));
  EXPECT_GT(importMesh(folder_.file("unseen/surface.ply"), 1).triangles.size(), 0u);
}

TEST_F(Run, WithoutAViewTheGpuStepsWhereItIsAskedFor) {
  const Json seen = metricsOf(run({"--set", "solver.backend=gpu"}));
  const Json unseen = metricsOf(run({"--no-view", "--set", "solver.backend=gpu"}));
  EXPECT_EQ(unseen["backend"], "gpu");
  EXPECT_EQ(unseen["images"], 0);
  EXPECT_EQ(unseen["state_hash"], seen["state_hash"]);
}

TEST_F(Run, PicturesDoNotChangeTheState) {
  const Json seen = metricsOf(run({"--strokes", strokes_, "--out", folder_.file("out")}));
  EXPECT_EQ(seen["state_hash"], metricsOf(run({"--strokes", strokes_}))["state_hash"]);
}

TEST_F(Run, OverrideChangesTheScene) {
  EXPECT_EQ(metricsOf(run({"--seconds", "0.02", "--set", "bodies[0].spacing_m=0.02"}))["nodes"], 27);
}

TEST_F(Run, SpacingThatTheMachineChoosesIsPrintedWithItsReason) {
  const auto nodesAt = [&](const std::string& factor) {
    const Ending ending =
        run({"--seconds", "0.02", "--set", "bodies[0].spacing_m=auto", "--set", "solver.real_time_factor=" + factor});
    const int nodes = metricsOf(ending)["nodes"];
    EXPECT_TRUE(says(ending.out, {"block: spacing_m: auto: ", " " + std::to_string(nodes) + " nodes, ",
                                  " of " + factor + " wanted: "}));
    return nodes;
  };
  EXPECT_LT(nodesAt("100"), nodesAt("2"));
}

TEST_F(Run, MeshOfTheCommandLineBecomesTheTissue) {
  const std::string tetrahedron = "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const std::string mesh = folder_.write("it's a mesh.obj", tetrahedron);
  const Json metrics = metricsOf(run({"--seconds", "0.02", "--mesh", mesh, "--set", "bodies[0].unit_scale_m=0.02"}));
  EXPECT_GT(metrics["nodes"], 8);
  EXPECT_NE(metrics["nodes"], 125);
}

TEST_F(Run, ShippedClothIsPressedLiftedAndCutByItsStrokes) {
  const Json metrics =
      metricsOf(viscera({"run", "cloth_on_points", "--strokes", sourceFolder() + "/config/strokes/cut_cloth.yaml",
                         "--set", "bodies[0].spacing_m=0.025", "--set", "cameras=[]"}));
  EXPECT_EQ(metrics["scene"], "cloth_on_points");
  EXPECT_GT(metrics["peak_force_n"], 0);
  EXPECT_GT(metrics["springs_cut"], 30);  // 32 cm, at least three springs every 2.5 cm
  EXPECT_LT(metrics["springs_cut"], 0.1 * metrics["springs"].get<double>());
  EXPECT_EQ(metrics["roll_backs"], 0);
  EXPECT_EQ(metrics["nonfinite"], 0);
}

TEST_F(Run, ShippedVesselBleedsUntilItIsClippedAndBurntAndItsReplayDoes) {
  const std::string strokes = sourceFolder() + "/config/strokes/bleeding.yaml";
  const auto bleeding = [&](const std::string& seconds, const std::string& recording) {
    return metricsOf(viscera({"run", "bleeding_vessel", "--no-view", "--strokes", strokes, "--seconds", seconds,
                              "--record", folder_.file(recording)}));
  };
  const Json divided = bleeding("2.5", "divided.viscera"), clipped = bleeding("5", "clipped.viscera"),
             burnt = bleeding("10", "burnt.viscera");
  EXPECT_EQ(divided["bleeding"]["stumps"], 2);
  EXPECT_NEAR(divided["bleeding"]["flow_ml_per_min"], 60, 1e-6) << "of two stumps";
  EXPECT_EQ(clipped["bleeding"]["stumps"], 1);
  EXPECT_EQ(burnt["bleeding"]["stumps"], 0);
  EXPECT_GT(burnt["bleeding"]["bled_ml"], clipped["bleeding"]["bled_ml"]);
  const Json again = metricsOf(viscera({"replay", folder_.file("burnt.viscera"), "--no-view"}));
  EXPECT_EQ(again["state_hash"], burnt["state_hash"]);
}

TEST_F(Run, ABladeCutsAsDeepAsItsTipIsPushedIn) {
  const auto cutAt = [&](int depth_mm) {
    const std::string z =
        ", -0.0" + std::string(depth_mm < 10 ? "0" : "") + std::to_string(depth_mm) + "], button2: true}\n";
    const std::string strokes =
        folder_.write("draw.yaml",
                      "strokes:\n  - stylus: right\n"
                      "    anchor: {from_m: [-0.002, -0.3, -0.015], towards_m: [-0.002, 0, -0.015]}\n    keys:\n"
                      "      - {t_s: 0, position_m: [0, 0.015, 0.03], button2: true}\n"
                      "      - {t_s: 0.1, position_m: [0, 0.015" +
                          z + "      - {t_s: 0.3, position_m: [0, -0.015" + z);
    return metricsOf(viscera({"run", "heart", "--strokes", strokes, "--no-view"}))["springs_cut"].get<int>();
  };
  constexpr int kThrough_mm = 14;  // the wall is 9 mm thick there
  const int shallow = cutAt(3), deeper = cutAt(6), through = cutAt(kThrough_mm);
  EXPECT_GT(shallow, 0);
  EXPECT_GT(deeper, 2 * shallow);
  EXPECT_GT(through, deeper);
  EXPECT_EQ(cutAt(20), through) << "the blade reaches back through the skin";
}

TEST_F(Run, AnchoredStrokesWrittenOutDoTheSame) {
  const std::string absolute = folder_.file("absolute.yaml");
  ASSERT_EQ(viscera({"anchor", scene_, "--strokes", strokes_, "--out", absolute}).status, 0);
  EXPECT_EQ(readFile(absolute).find("anchor"), std::string::npos);
  const Json anchored = metricsOf(run({"--strokes", strokes_})), written = metricsOf(run({"--strokes", absolute}));
  EXPECT_EQ(written["springs_cut"], anchored["springs_cut"]);
  EXPECT_EQ(written["steps"], anchored["steps"]);
}

TEST(Check, NamesTheRendererAndTheDeviceTaken) {
  const Ending ending = viscera({"check"});
  EXPECT_EQ(ending.status, 0) << ending.err;
  EXPECT_TRUE(says(ending.out, {"* device ", "renderer: ", "OpenGL:   4."}));
}

/// Returns the rows of a table of the speed suite, below its header.
std::vector<std::string> speedRows(const std::string& part, const std::vector<std::string>& options) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments = {"bench", "speed", "--only", part, "--out", folder.path()};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Ending ending = viscera(arguments);
  EXPECT_EQ(ending.status, 0) << ending.err;
  std::vector<std::string> lines = linesOf(readFile(folder.file("speed_" + part + ".csv")));
  if (!lines.empty()) lines.erase(lines.begin());
  return lines;
}

TEST(Bench, TicksHaveOneRowForACubeAndOneForAHeartOnEachBackendAskedFor) {
  const auto hashOf = [](const std::string& row) { return row.substr(row.rfind(',')); };
  const auto one = speedRows("ticks", {"--nodes", "1000", "--backend", "cpu", "--threads", "1"});
  const auto both = speedRows("ticks", {"--nodes", "1000", "--backend", "both", "--threads", "3"});
  ASSERT_EQ(one.size(), 2u);
  EXPECT_EQ(one[0].rfind("cube,1000,cpu,1,", 0), 0u) << one[0];
  EXPECT_EQ(one[1].rfind("heart,", 0), 0u) << one[1];
  EXPECT_NEAR(std::stod(one[1].substr(6)), 1000, 20);  // target_nodes is met within 2 %
  ASSERT_EQ(both.size(), 4u);
  EXPECT_EQ(both[0].rfind("cube,1000,cpu,3,", 0), 0u) << both[0];
  EXPECT_EQ(both[1].rfind("cube,1000,gpu,", 0), 0u) << both[1];
  EXPECT_EQ(hashOf(one[0]), hashOf(both[0]));  // the same motion on any number of threads
}

TEST(Bench, TicksAreThoseOfAScene) {
  const auto rows = speedRows("ticks", {"--scene", "heart", "--set", "bodies[0].spacing_m=0.01", "--backend", "cpu"});
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].rfind("heart,", 0), 0u) << rows[0];
}

TEST(Bench, StagesOfAGpuStepAreTimedEach) {
  const auto rows = speedRows("stages", {"--nodes", "1000"});
  for (const std::string stage : {"step", "cut", "measure", "reaction", "surface", "render"}) {
    const auto is_it = [&](const std::string& row) { return says(row, {"cube,1000," + stage + ','}); };
    EXPECT_TRUE(std::any_of(rows.begin(), rows.end(), is_it)) << stage;
  }
}

TEST(Keys, PrintsTheTableOfSceneKeys) {
  const Ending ending = viscera({"keys"});
  EXPECT_EQ(ending.status, 0);
  EXPECT_TRUE(says(ending.out, {"| key | type, unit | default | range | meaning |", "| `bodies[].spacing_m` |",
                                "| `bodies[].material.young_modulus_pa` | number, Pa | 20000 | 1 .. 1e+09 |"}));
}

}  // namespace
}  // namespace viscera
