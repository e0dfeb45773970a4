// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "bench/harness/block.h"
#include "bench/harness/mode_frequency.h"
#include "bench/suites/material_parts.h"

namespace viscera::bench {

namespace {

// A plane wave is exact in an unbounded lattice only: at a free side the tissue widens. But one substep carries news
// from a node to the next and no farther, so in a free block a node d nodes from the surface moves for d substeps
// exactly as in an unbounded lattice. Only those are looked at.
constexpr int kSubsteps = 12;
constexpr double kStrain = 1e-5;    ///< so small that springs are linear
constexpr double kPhaseStep = 1.5;  ///< between samples, at most
constexpr double kLimit = 1e-4;     ///< issue 3: relative

struct Wave {
  int axis;  ///< of the displacement: 2 longitudinal, 0 transverse; it travels along z
  double q;  ///< wave number times spacing
};

/// E for which k = mu h = 1 N/m at h = 1 m.
MaterialConfig waveMaterial(double nu) {
  MaterialConfig material = unitMaterial();
  material.poisson_ratio = nu;
  material.young_modulus_pa = 2 * (1 + nu);
  return material;
}

/// Long-wave speed [m/s]: c_p or c_s, with mu = rho = 1.
double speedOf(double nu, const Wave& wave) {
  return wave.axis == 2 ? std::sqrt(2 + 2 * nu / (1 - 2 * nu)) : 1;
}

/// Of the lattice: a row of cells is a chain of springs c^2 m/h^2, the energy of volume included.
double formula(double nu, const Wave& wave) {
  return 2 * speedOf(nu, wave) * std::sin(wave.q / 2);
}

/// A free block of cells and the solver on it, for one nu.
class WaveTank {
 public:
  WaveTank(double nu, int cells)
      : model_(blockModel(Vector3i::Constant(cells), 1, waveMaterial(nu))),
        solver_(model_, plainScene(model_, 1)),
        middle_(cells / 2) {
    const Lattice& lattice = model_.bodies[0].lattice;
    for (uint32_t slot : lattice.active_slots) {
      const Eigen::Array3i n = lattice.nodeAt(slot).array();
      if (std::min(n.minCoeff(), (cells - n).minCoeff()) >= kSubsteps) inner_.push_back(slot);
    }
  }

  /// Frequency of a standing wave [rad/s]. @param expected  about as much
  double measure(const Wave& wave, double expected) {
    const double phase = phasePerSubstep(expected, solver_.dt_s());
    const int stride = std::clamp(static_cast<int>(kPhaseStep / phase), 1, kSubsteps / 2);
    const Field start = standing(wave);
    solver_.writeState(stateOf(model_, start));
    std::vector<double> amplitude;
    for (int n = 0; n <= kSubsteps; ++n) {
      if (n % stride == 0) amplitude.push_back(projection(start));
      solver_.step({});
    }
    return modeFrequency(amplitude, stride, solver_.dt_s());
  }

 private:
  /// Largest in the middle of the block.
  Field standing(const Wave& wave) const {
    const Lattice& lattice = model_.bodies[0].lattice;
    Field u(model_.slots(), Vector3d::Zero());
    for (uint32_t slot : lattice.active_slots) {
      u[slot][wave.axis] = kStrain / wave.q * std::cos(wave.q * (lattice.nodeAt(slot).z() - middle_));
    }
    return u;
  }
  double projection(const Field& shape) const {
    const HostState state = solver_.readState();
    double sum = 0;
    for (uint32_t slot : inner_) sum += shape[slot].dot(xyz(state.displacement_m[slot]));
    return sum;
  }

  Model model_;
  GpuSolver solver_;
  int middle_;
  std::vector<uint32_t> inner_;  ///< slots that know nothing of the surface yet
};

}  // namespace

void measurePlaneWaves(Report& report) {
  Table table("Plane waves along an axis of the lattice on the GPU, k = m = h = 1; leapfrog's time error taken out",
              {{"wave"},
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
  Series found[] = {{"longitudinal, all nu", {}, {}, Series::Style::kPoints},
                    {"transverse, all nu", {}, {}, Series::Style::kPoints}};
  double worst = 0;
  const std::vector<double> ratios =
      report.isShort() ? std::vector<double>{0.25, 0.45} : std::vector<double>{0, 0.25, 0.4, 0.45, 0.49};
  const std::vector<double> lengths =
      report.isShort() ? std::vector<double>{4, 12} : std::vector<double>{2, 3, 4, 6, 12};
  for (double nu : ratios) {
    report.stage("plane waves, nu " + Cell(nu).text(3));
    WaveTank tank(nu, report.isShort() ? 2 * kSubsteps + 2 : 2 * kSubsteps + 6);
    for (int axis : {2, 0}) {
      const std::string name = axis == 2 ? "longitudinal" : "transverse";
      Series& series = found[axis == 2 ? 0 : 1];
      for (double length : lengths) {
        const Wave wave{axis, 2 * M_PI / length};
        const double wanted = formula(nu, wave), omega = tank.measure(wave, wanted), error = omega / wanted - 1;
        const double speed = omega / (wave.q * speedOf(nu, wave));
        table.add({name, nu, wave.q, wanted, omega, error, speed});
        series.x.push_back(wave.q);
        series.y.push_back(speed);
        worst = std::max(worst, std::abs(error));
      }
    }
  }
  plot.series = {exact, found[0], found[1]};
  report.add(table, "waves");
  report.add(plot, "waves");
  report.checkAtMost("plane waves: largest relative error of a frequency", worst, kLimit);
}

}  // namespace viscera::bench
