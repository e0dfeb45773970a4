// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>

#include "bench/harness/specimens/block.h"
#include "bench/harness/specimens/mode_frequency.h"
#include "bench/suites/material/material_parts.h"

namespace viscera::bench {

namespace {

// A plane wave is exact in an unbounded lattice only: at a free side the tissue widens. But a substep transmits changes
// to adjacent nodes only. So in a free block, a node d nodes from the surface moves for d substeps exactly as in an
// unbounded lattice. Only those nodes are evaluated.
constexpr int kSubsteps = 12;
constexpr double kMaterialWavesStrain = 1e-5;    ///< so small that springs and cells are linear
constexpr double kMaterialWavesPhaseStep = 1.5;  ///< largest phase between samples
constexpr double kMaterialWavesLimit = 1e-4;     ///< issue 3: relative

struct Wave {
  int axis;  ///< axis of the displacement: 2 longitudinal, 0 transverse; the wave travels along z
  double q;  ///< wave number times spacing
};

/// Returns a material with mu h = 1 N/m at h = 1 m.
MaterialConfig waveMaterial(double nu) {
  MaterialConfig material = withPoisson(unitMaterial(), nu);
  material.young_modulus_pa = 2 * (1 + nu);
  return material;
}

/// Returns the long-wave speed [m/s]: c_p or c_s, with mu = rho = 1.
double speedOf(double nu, const Wave& wave) {
  return wave.axis == 2 ? std::sqrt(2 + 2 * nu / (1 - 2 * nu)) : 1;
}

/// Returns the lattice's frequency: along an axis a row of cells, of springs or of a law, is a chain of springs c^2
/// m/h^2.
double formula(double nu, const Wave& wave) {
  return 2 * speedOf(nu, wave) * std::sin(wave.q / 2);
}

/// A free block of cells and its solver, for one nu.
class WaveTank {
 public:
  WaveTank(Backend backend, double nu, int cells)
      : model_(blockModel(Vector3i::Constant(cells), 1, waveMaterial(nu))),
        solver_(solverOn(backend, model_, plainScene(model_, 1))),
        middle_(cells / 2) {
    const Lattice& lattice = model_.bodies[0].lattice;
    for (uint32_t slot : lattice.active_slots) {
      const Eigen::Array3i n = lattice.nodeAt(slot).array();
      if (std::min(n.minCoeff(), (cells - n).minCoeff()) >= kSubsteps) inner_.push_back(slot);
    }
  }

  /// Returns the frequency of a standing wave [rad/s]. @param expected  approximate value
  double measure(const Wave& wave, double expected) {
    const double phase = phasePerSubstep(expected, solver_->dt_s());
    const int stride = std::clamp(static_cast<int>(kMaterialWavesPhaseStep / phase), 1, kSubsteps / 2);
    const Field start = standing(wave);
    solver_->writeState(stateOf(model_, start));
    std::vector<double> amplitude;
    for (int n = 0; n <= kSubsteps; ++n) {
      if (n % stride == 0) amplitude.push_back(projection(start));
      solver_->step({});
    }
    return modeFrequency(amplitude, stride, solver_->dt_s());
  }

 private:
  /// Returns a standing wave with its maximum at the centre of the block.
  Field standing(const Wave& wave) const {
    const Lattice& lattice = model_.bodies[0].lattice;
    Field u(model_.slots(), Vector3d::Zero());
    for (uint32_t slot : lattice.active_slots) {
      u[slot][wave.axis] = kMaterialWavesStrain / wave.q * std::cos(wave.q * (lattice.nodeAt(slot).z() - middle_));
    }
    return u;
  }
  double projection(const Field& shape) const {
    const HostState state = solver_->readState();
    double sum = 0;
    for (uint32_t slot : inner_) sum += shape[slot].dot(xyz(state.displacement_m[slot]));
    return sum;
  }

  Model model_;
  std::unique_ptr<TissueStepper> solver_;
  int middle_;
  std::vector<uint32_t> inner_;  ///< slots that the surface does not affect yet
};

/// Measures all kinds of waves on one backend: rows of the table, points of the diagram.
class WaveTests {
 public:
  WaveTests(Report& report, Table& table) : report_(report), table_(table) {}

  /// Measures a backend. @return points of longitudinal and transverse waves
  std::array<Series, 2> run(Backend backend) {
    const bool brief = report_.isShort();
    std::array<Series, 2> found = {{{nameOf(backend) + ": longitudinal, all nu", {}, {}, Series::Style::kPoints},
                                    {nameOf(backend) + ": transverse, all nu", {}, {}, Series::Style::kPoints}}};
    worst_ = 0;
    for (double nu : brief ? std::vector<double>{0.25, 0.45} : std::vector<double>{0, 0.25, 0.4, 0.45, 0.49}) {
      report_.stage("plane waves, nu " + Cell(nu).text(3) + ", " + nameOf(backend));
      WaveTank tank(backend, nu, brief ? 2 * kSubsteps + 2 : 2 * kSubsteps + 6);
      for (int axis : {2, 0}) {
        for (double length : brief ? std::vector<double>{4, 12} : std::vector<double>{2, 3, 4, 6, 12}) {
          measure(backend, nu, {axis, 2 * M_PI / length}, tank, found[axis == 2 ? 0 : 1]);
        }
      }
    }
    report_.checkAtMost(nameOf(backend) + ": plane waves: largest relative error of a frequency", worst_,
                        kMaterialWavesLimit);
    return found;
  }

 private:
  void measure(Backend backend, double nu, const Wave& wave, WaveTank& tank, Series& series) {
    const double wanted = formula(nu, wave), omega = tank.measure(wave, wanted), error = omega / wanted - 1;
    const double speed = omega / (wave.q * speedOf(nu, wave));
    table_.add(
        {nameOf(backend), wave.axis == 2 ? "longitudinal" : "transverse", nu, wave.q, wanted, omega, error, speed});
    series.x.push_back(wave.q);
    series.y.push_back(speed);
    worst_ = std::max(worst_, std::abs(error));
  }

  Report& report_;
  Table& table_;
  double worst_ = 0;
};

}  // namespace

void measurePlaneWaves(Report& report) {
  Table table("Plane waves along an axis of the lattice, k = m = h = 1; leapfrog's time error taken out",
              {{"backend"},
               {"wave"},
               {"nu"},
               {"q h", "", 5},
               {"formula", "rad/s", 7},
               {"measured", "rad/s", 7},
               {"relative error"},
               {"speed / continuum", "", 5}});
  Plot plot{"Dispersion of plane waves", "q h", "phase speed / continuum's", false, false, {}};
  Series exact{"formula", {}, {}, Series::Style::kLines};
  for (double q = 0.02; q < M_PI; q += 0.02) {
    exact.x.push_back(q);
    exact.y.push_back(2 * std::sin(q / 2) / q);
  }
  plot.series = {exact};
  WaveTests tests(report, table);
  for (Backend backend : report.backends()) {
    for (const Series& series : tests.run(backend)) plot.series.push_back(series);
  }
  report.add(table, "waves");
  report.add(plot, "waves");
}

}  // namespace viscera::bench
