// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Walls of cavities under pressure that are cut or erased (docs/physics.md 18).
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "model/body/body_nodes.h"
#include "solver/cpu/cpu_solver.h"
#include "solver/processes/bleed/bleeding.h"
#include "solver/processes/pressure/pipe.h"
#include "viscera/model/body/neighbors.h"

namespace viscera {
namespace {

using test::cutAcross;
using test::kHeldEnds;
using test::kInner_m;
using test::pipe;
using test::pressureFact;
using test::pressuresOf;

/// Blood of a wall without vessels of its own comes out in any amount. Stumps are those of bodies that bleed.
TEST(OpenedWalls, BleedWithoutVesselsOfTheirOwn) {
  for (const bool bleeds : {true, false}) {
    Scene scene = pipe(std::string("young_modulus_pa: 1.0e+5, density_kg_per_m3: 1.0e+4, mass_damping_per_s: 30") +
                           (bleeds ? ", bleeding: {flow_ml_per_min: 120}" : ""),
                       3000, "parts: [{part: tube, bleeding: {flow_ml_per_min: 0}}], " + std::string(kHeldEnds));
    BodyConfig block;
    block.name = "block";
    block.source = TissueSource::kBox;
    block.box_size_m = {0.004, 0.004, 0.004};
    block.spacing_m = 0.001;
    block.position_m = {0, 0.05, 0};
    block.material.bleeding.flow_ml_per_min = 1;
    scene.bodies.push_back(block);
    scene.styluses.resize(1);
    scene.styluses[0].cut.blade_length_m = 0.03;
    const Model model = buildModel(scene);
    CpuSolver solver(model, scene);
    for (int t = 0; t < 13; ++t) solver.step(ToolMotions{});
    cutAcross(solver, 0.006);
    for (int t = 0; t < 5; ++t) solver.step(ToolMotions{});
    EXPECT_GT(pressureFact(solver, "flow_ml_per_min"), 0);
    EXPECT_EQ(pressuresOf(solver).openStations() > 0, bleeds);
    EXPECT_EQ(findProcess<Bleeding>(solver)->seen().stumps, pressuresOf(solver).openStations());
    EXPECT_EQ(findProcess<Bleeding>(solver)->seen().flow_ml_per_min > 0, bleeds);
  }
}

/// Nodes with a displacement each.
class MovedNodes : public TissuePort {
 public:
  void readNodes(const std::vector<uint32_t>& slots, std::vector<Vector3f>& u_m,
                 std::vector<Vector3f>& v_m_per_s) const override {
    for (size_t i = 0; i < slots.size(); ++i) {
      u_m[i] = 1e-3F * Vector3f::Constant(std::sin(static_cast<float>(slots[i])));
      v_m_per_s[i] = Vector3f::Zero();
    }
  }
  void pushNodes(uint32_t, float, const std::vector<uint32_t>&, const std::vector<Vector3f>&) override {}
  void selectBody(size_t) override {}
  void cutAtRest(const layout::ToolMotion&, bool) override {}
};

/// Returns the positions of some vertices after a tick with these nodes.
std::vector<double> positionsIn(Pressures& pressures, uint32_t vertices) {
  MovedNodes port;
  const ToolMotions motions{};
  const ObstacleMotions obstacles{};
  pressures.endTick(port, {motions, obstacles}, {});
  std::vector<double> out;
  for (uint32_t v = 0; v < vertices; ++v)
    for (const double x : pressures.loads().position_m(v)) out.push_back(x);
  return out;
}

/// Cuts the springs along an axis of all nodes of a body in a layer across the x axis.
void cutLayer(const Body& body, int layer, uint32_t axis, CutSprings& cuts) {
  for (const uint32_t slot : body.lattice.active_slots) {
    if (body.lattice.nodeAt(slot).x() != layer) continue;
    for (const uint32_t spring : {2 * axis, 2 * axis + 1}) setSpringCount(cuts.nodes[slot], spring, 0);
  }
}

/// The second cut is through the cells that carry the walls of the first one, and not through these walls: a saved
/// state knows the last cuts alone.
TEST(OpenedWalls, AreCarriedAlikeAfterCutsOneByOneAndAtOnce) {
  const Scene scene = pipe("young_modulus_pa: 1.0e+5", 1000, kHeldEnds);
  const Model model = buildModel(scene);
  const Body& body = model.bodies[0];
  const auto vertices = static_cast<uint32_t>(cavitiesOf(body, scene.bodies[0]).positions_m.size());
  const int middle = body.lattice.nodeAt(body.lattice.active_slots[body.lattice.active_slots.size() / 2]).x();
  Pressures one_by_one(scene, model), at_once(scene, model);
  CutSprings cuts{body.lattice.nodes, {}};
  cutLayer(body, middle, 0, cuts);
  one_by_one.cutsChanged(cuts);
  const std::vector<double> after_one = positionsIn(one_by_one, vertices);
  for (const int layer : {middle - 2, middle + 2}) cutLayer(body, layer, 1, cuts);
  one_by_one.cutsChanged(cuts);
  at_once.cutsChanged(cuts);
  EXPECT_EQ(positionsIn(one_by_one, vertices), positionsIn(at_once, vertices));
  EXPECT_NE(positionsIn(at_once, vertices), after_one);
}

/// Tissue that is gone leaves a hole of its area.
TEST(OpenedWalls, AreOpenWhereTheyAreErased) {
  const Scene scene = pipe("young_modulus_pa: 1.0e+5", 1000, kHeldEnds);
  const Model model = buildModel(scene);
  Pressures pressures(scene, model);
  CutSprings cuts{model.bodies[0].lattice.nodes, {}};
  const auto open_m2 = [&] {
    pressures.cutsChanged(cuts);
    positionsIn(pressures, 0);
    return pressureFact(pressures, "open_m2");
  };
  EXPECT_EQ(open_m2(), 0);
  for (const uint32_t slot : model.bodies[0].lattice.active_slots)
    if (std::abs(restPosition(model.bodies[0], slot).x()) < 0.004)
      for (uint32_t spring = 0; spring < 18; ++spring) setSpringCount(cuts.nodes[slot], spring, 0);
  EXPECT_GT(open_m2(), kInner_m * kInner_m);
}

}  // namespace
}  // namespace viscera
