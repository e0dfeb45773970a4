// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Bullet's deformable tetrahedra under their weight, for scripts/compare.
//
//     bullet_tetrahedra MESH MOVED LAW E NU DENSITY GX GY GZ STEP SECONDS
//
// MESH: text; the numbers of nodes and tetrahedra, then a line "x y z held" for each node [m], then four nodes for each
// tetrahedron. MOVED: file for the displacement of each node [m]. LAW: linear (corotational) or neo_hooke. E [Pa],
// DENSITY [kg/m3], G [m/s2], STEP: of implicit Euler [s], SECONDS: simulated time. Prints the processor time of
// stepping over the simulated time, and how far the most distant node still moved in the last tenth of that time, as
// JSON.
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableLinearElasticityForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btDeformableNeoHookeanForce.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <btBulletDynamicsCommon.h>
#include <time.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

namespace {

constexpr double kUnits = 10;       // Bullet's units per metre: its contacts suit bodies of about one unit
constexpr double kDamping = 0.1;    // of its elastic forces, relative to their stiffness
constexpr double kMargin_m = 1e-4;  // of its shapes

double processorSeconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return now.tv_sec + 1e-9 * now.tv_nsec;
}

struct Mesh {
  std::vector<btVector3> nodes;
  std::vector<bool> held;
  std::vector<std::vector<int>> cells;
};

Mesh readMesh(const char* path) {
  std::ifstream in(path);
  size_t nodes = 0, cells = 0;
  in >> nodes >> cells;
  Mesh mesh;
  for (size_t i = 0; i < nodes; ++i) {
    double x, y, z;
    int held;
    in >> x >> y >> z >> held;
    mesh.nodes.emplace_back(kUnits * x, kUnits * y, kUnits * z);
    mesh.held.push_back(held != 0);
  }
  for (size_t i = 0; i < cells; ++i) {
    std::vector<int> cell(4);
    for (int& node : cell) in >> node;
    mesh.cells.push_back(cell);
  }
  if (!in) {
    std::fprintf(stderr, "%s: no mesh\n", path);
    std::exit(2);
  }
  return mesh;
}

btSoftBody* bodyOf(const Mesh& mesh, btSoftBodyWorldInfo& info, double density) {
  auto* body = new btSoftBody(&info, static_cast<int>(mesh.nodes.size()), mesh.nodes.data(), nullptr);
  std::vector<double> mass_kg(mesh.nodes.size());
  for (const std::vector<int>& cell : mesh.cells) {
    const btVector3 &a = mesh.nodes[cell[0]], &b = mesh.nodes[cell[1]], &c = mesh.nodes[cell[2]],
                    &d = mesh.nodes[cell[3]];
    const double volume = std::abs((b - a).dot((c - a).cross(d - a))) / 6 / std::pow(kUnits, 3);
    body->appendTetra(cell[0], cell[1], cell[2], cell[3]);
    for (const int node : cell) mass_kg[node] += density * volume / 4;
  }
  btSoftBodyHelpers::generateBoundaryFaces(body);
  body->initializeDmInverse();
  body->m_tetraScratches.resize(body->m_tetras.size());
  body->m_tetraScratchesTn.resize(body->m_tetras.size());
  for (size_t i = 0; i < mesh.nodes.size(); ++i) body->setMass(static_cast<int>(i), mesh.held[i] ? 0 : mass_kg[i]);
  body->m_cfg.kDF = body->m_cfg.kDP = body->m_cfg.drag = 0;
  body->m_cfg.collisions = 0;
  body->setSelfCollision(false);
  body->m_sleepingThreshold = 0;
  body->setActivationState(DISABLE_DEACTIVATION);
  body->getCollisionShape()->setMargin(kMargin_m * kUnits);
  body->setDampingCoefficient(0);
  return body;
}

}  // namespace

int main(int count, char** words) {
  if (count != 12) return std::fprintf(stderr, "usage: see bullet_tetrahedra.cpp\n"), 2;
  const Mesh mesh = readMesh(words[1]);
  const std::string law = words[3];
  const double young_pa = std::atof(words[4]), ratio = std::atof(words[5]), density = std::atof(words[6]);
  const btVector3 gravity = kUnits * btVector3(std::atof(words[7]), std::atof(words[8]), std::atof(words[9]));
  const double step_s = std::atof(words[10]), seconds = std::atof(words[11]);

  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btDeformableBodySolver solver;
  btDeformableMultiBodyConstraintSolver constraints;
  constraints.setDeformableSolver(&solver);
  btDeformableMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &constraints, &configuration, &solver);
  world.setGravity(gravity);
  world.getWorldInfo().m_gravity = gravity;
  world.setImplicit(true);
  world.setLineSearch(false);
  world.setUseProjection(true);
  btSoftBody* body = bodyOf(mesh, world.getWorldInfo(), density);
  world.addSoftBody(body);
  // A stress is a force over an area: newtons scale with Bullet's unit of length, areas with its square.
  const double mu = young_pa / kUnits / (2 * (1 + ratio)), lambda = 2 * mu * ratio / (1 - 2 * ratio);
  if (law == "neo_hooke")
    world.addForce(body, new btDeformableNeoHookeanForce(mu, lambda, kDamping));
  else
    world.addForce(body, new btDeformableLinearElasticityForce(mu, lambda, 0, kDamping));
  world.addForce(body, new btDeformableGravityForce(gravity));

  const int steps = static_cast<int>(std::lround(seconds / step_s)), late = steps * 9 / 10;
  std::vector<btVector3> before(mesh.nodes.size());
  const double begun = processorSeconds();
  for (int k = 0; k < steps; ++k) {
    world.stepSimulation(step_s, 0, step_s);
    for (size_t i = 0; k == late && i < before.size(); ++i) before[i] = body->m_nodes[i].m_x;
  }
  const double cost = (processorSeconds() - begun) / seconds;
  double creep = 0;
  std::ofstream out(words[2]);
  out.precision(9);
  for (size_t i = 0; i < mesh.nodes.size(); ++i) {
    const btVector3 moved = (body->m_nodes[i].m_x - mesh.nodes[i]) / kUnits;
    creep = std::max(creep, static_cast<double>((body->m_nodes[i].m_x - before[i]).length()) / kUnits);
    out << moved.x() << ' ' << moved.y() << ' ' << moved.z() << '\n';
  }
  std::printf("{\"nodes\": %zu, \"cost\": %.6g, \"creep_m\": %.3g}\n", mesh.nodes.size(), cost, creep);
  return 0;
}
