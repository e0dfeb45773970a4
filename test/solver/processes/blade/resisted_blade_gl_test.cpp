// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A blade that tissue resists is the same on the GPU as on the CPU: force, area, work; saved, rolled back, and in
// sleeping tissue.
#include <limits>

#include "math/archive.h"
#include "solver/processes/blade/blades.h"
#include "support/solver_rig.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kResistedBladeStep_m = 0.001;  // per tick
constexpr int kTicks = 45;
/// Of the largest force, of the area and of the work: some roundings of float32, 6e-8 each.
constexpr double kResistedBladeRounding = 1e-6;
/// The same where a tick's substeps follow the stretch of the tissue, which the GPU knows a tick later. In one tick of
/// a cut it has other substeps than the CPU, with other steps of the fronts.
constexpr double kOtherSubsteps = 0.01;

Scene blockOnAPlate() {
  Scene scene;
  BodyConfig body;
  body.source = TissueSource::kBox;
  body.box_size_m = {0.04, 0.04, 0.02};
  body.spacing_m = 0.004;
  body.material.cut.toughness_j_per_m2 = 100;
  FixedConfig plate;
  plate.min_m = {-1, -1, -1};
  plate.max_m = {1, 1, -0.0099};
  body.fixed.push_back(plate);
  scene.bodies.push_back(body);
  StylusConfig stylus;
  stylus.idle = ToolMode::kCut;
  scene.styluses.push_back(stylus);
  scene.environment.gravity_m_per_s2.setZero();
  return scene;
}

/// A stylus that moves straight through the block.
class PushingTool {
 public:
  explicit PushingTool(const std::string& backend, const Scene& scene = blockOnAPlate())
      : hz_(scene.solver.tick_hz), model_(buildModel(scene)), solver_(makeBackend(backend, model_, scene)) {}
  /// Moves by one tick. @returns the force on the tissue in it [N]
  Vector3d tick(int i) {
    solver_->step(tool(ToolMode::kCut, tip(i), tip(i + 1)));
    layout::TickStats stats{};
    while (solver_->pollStats(stats, true)) bad_ += stats.nonfinite;
    return hz_ * xyz(stats.impulse[0]);
  }
  void without(int ticks) {
    for (int i = 0; i < ticks; ++i) solver_->step({});
  }
  /// Moves far from the block, in mode cut.
  void hover(int ticks) {
    for (int i = 0; i < ticks; ++i) solver_->step(tool(ToolMode::kCut, {-0.03, 0.001, 0.3}, {-0.03, 0.001, 0.3}));
  }
  TissueStepper& solver() { return *solver_; }
  BladeWork done() const { return bladeWork(*solver_, 0); }
  uint64_t hash() const { return stateHash(model_, solver_->readState()); }
  uint64_t bad() const { return bad_; }
  static Vector3d tip(int i) { return {-0.03 + kResistedBladeStep_m * i, 0.001, 0.002}; }

 private:
  double hz_;
  Model model_;
  std::unique_ptr<TissueStepper> solver_;
  uint64_t bad_ = 0;
};

class ResistedBlade : public GpuTest {};

void expectSameDone(const BladeWork& gpu, const BladeWork& cpu, double share) {
  ASSERT_GT(cpu.area_m2, 0);
  EXPECT_NEAR(gpu.area_m2, cpu.area_m2, share * cpu.area_m2);
  EXPECT_NEAR(gpu.work_j, cpu.work_j, share * cpu.work_j);
  EXPECT_NEAR(gpu.parting_j, cpu.parting_j, share * cpu.parting_j);
}

void expectSameStroke(const Scene& scene, double share = kResistedBladeRounding) {
  PushingTool cpu(backendKinds()[1], scene), gpu("gpu", scene);
  double most_n = 0, apart_n = 0;
  for (int i = 0; i < kTicks; ++i) {
    const Vector3d on_cpu = cpu.tick(i), on_gpu = gpu.tick(i);
    most_n = std::max(most_n, on_cpu.norm());
    apart_n = std::max(apart_n, (on_cpu - on_gpu).norm());
  }
  EXPECT_GT(most_n, 0.02);
  EXPECT_LT(apart_n, share * most_n);
  expectSameDone(gpu.done(), cpu.done(), share);
  EXPECT_EQ(gpu.bad(), 0u);
  const auto severed = [](PushingTool& tool) {
    const HostState state = tool.solver().readState();
    return std::count_if(state.nodes.begin(), state.nodes.end(),
                         [](const layout::NodeBits& bits) { return (bits.lo & layout::kSeveredBit) != 0; });
  };
  if (share > kResistedBladeRounding) return;
  EXPECT_EQ(severed(gpu), severed(cpu));
}

}  // namespace

/// With and without a stability monitor, which only adapts the substeps here.
TEST_F(ResistedBlade, CutsAsOnTheCpu) {
  Scene scene = blockOnAPlate();
  scene.solver.substeps = 46;
  expectSameStroke(scene);
  scene.solver.substeps = 0;
  scene.solver.stability_monitor = false;
  expectSameStroke(scene);
}

TEST_F(ResistedBlade, CutsWhereSubstepsFollowTheTissue) {
  expectSameStroke(blockOnAPlate(), kOtherSubsteps);
}

TEST_F(ResistedBlade, CutsTissueThatSleeps) {
  Scene scene = blockOnAPlate();
  scene.solver.stability_monitor = false;
  PushingTool gpu("gpu", scene), cpu(backendKinds()[1], scene);
  for (PushingTool* tool : {&gpu, &cpu}) {
    tool->without(60);
    tool->hover(5);
    if (tool == &gpu) {
      EXPECT_TRUE(static_cast<GpuSolver&>(gpu.solver()).resting());
    }
    for (int i = 0; i < kTicks; ++i) tool->tick(i);
    tool->without(10);  // the end of the cut follows when the blade is gone
  }
  expectSameDone(gpu.done(), cpu.done(), kResistedBladeRounding);
}

TEST_F(ResistedBlade, CutsEveryStructure) {
  for (const Structure structure : {Structure::kExplicit, Structure::kSurface}) {
    Scene scene = blockOnAPlate();
    scene.solver.stability_monitor = false;
    BodyConfig& body = scene.bodies[0];
    body.structure = structure;
    if (structure == Structure::kSurface) {
      body.source = TissueSource::kSheet;
      body.thickness_m = 0.001;
      body.box_size_m.z() = 0.001;
      body.position_m.z() = 0.01;
      body.fixed.push_back(body.fixed[0]);
      body.fixed[0].min_m = {-1, 0.0179, -1};
      body.fixed[0].max_m = {1, 1, 1};
      body.fixed[1].max_m = {1, -0.0179, 1};
    }
    expectSameStroke(scene, kResistedBladeRounding);
  }
}

TEST_F(ResistedBlade, CutsBesideABodyThatResistsNothing) {
  Scene scene = blockOnAPlate();
  scene.solver.stability_monitor = false;
  scene.bodies[0].spacing_m = 0.005;
  scene.bodies.push_back(scene.bodies[0]);
  scene.bodies[1].material.cut = {};
  scene.bodies[1].position_m.z() = 0.021;
  expectSameStroke(scene);
}

TEST_F(ResistedBlade, GoesOnToTheBitFromASavedState) {
  PushingTool first("gpu"), second("gpu");
  for (int i = 0; i < 25; ++i) first.tick(i);
  for (int i = 0; i < 3; ++i) second.tick(i);
  Archive saved;
  first.solver().persist(saved);
  Archive read(saved.sections());
  second.solver().persist(read);
  for (int i = 25; i < 35; ++i) {
    first.tick(i);
    second.tick(i);
  }
  EXPECT_EQ(first.hash(), second.hash());
  EXPECT_EQ(first.done().work_j, second.done().work_j);
}

TEST_F(ResistedBlade, GoesOnAfterARollback) {
  PushingTool gpu("gpu");
  for (int i = 0; i < 25; ++i) gpu.tick(i);
  const double before_m2 = gpu.done().area_m2;
  HostState broken = gpu.solver().readState();
  for (layout::vec4& v : broken.velocity_m_per_s) v.x = 200;
  gpu.solver().writeState(broken, true);
  for (int i = 25; i < kTicks; ++i) gpu.tick(i);
  EXPECT_GE(gpu.solver().health().trips, 1u);
  EXPECT_GT(gpu.done().area_m2, before_m2);
  EXPECT_TRUE(isFinite(gpu.solver().readState()));
}
