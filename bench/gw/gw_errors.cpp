// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <functional>
#include <memory>

#include "bench/gw/gw_kernels.h"
#include "bench/gw/gw_parts.h"
#include "bench/harness/experiment.h"
#include "solver/reference/reference_solver.h"

namespace viscera::bench {

namespace {

constexpr double kAgreement = 1e-6;   ///< point- against edge-centric, relative to the largest force
constexpr double kBlending32 = 1e-5;  ///< 32-bit blending against float64, relative to the largest force
constexpr double kDtFraction = 0.5;   ///< substep relative to the largest stable one
constexpr double kHeadroom = 2;       ///< range of a target relative to the largest sum of the true motion
constexpr double kMotion = 1e-5;      ///< methods in float32 against float64, relative to the largest u
const Vector3d kGravity_m_per_s2(0, 0, -9.81);

/// Gathers forces by one of the methods. @return the target that contains them, if any
using Gather = std::function<const BlendTarget*(GwKernels&)>;
struct Variant {
  std::string name;
  StateFormat state;
  Gather gather;
};

Variant edgeVariant(const std::string& name) {
  return {name, StateFormat::kFloat32, [](GwKernels& kernels) -> const BlendTarget* {
            kernels.springForces();
            kernels.sumForces();
            return nullptr;
          }};
}

Variant pointVariant(const std::string& name, StateFormat state) {
  return {name, state, [](GwKernels& kernels) -> const BlendTarget* {
            kernels.pointForces();
            return nullptr;
          }};
}

Variant blendVariant(BlendFormat format, size_t slots, double scale_n) {
  auto target = std::make_shared<BlendTarget>(format, slots, scale_n);
  return {std::string("blending, ") + nameOf(format), StateFormat::kFloat32,
          [target](GwKernels& kernels) -> const BlendTarget* {
            kernels.forceTexture();
            kernels.scatterForces(*target);
            return target.get();
          }};
}

enum { kPoint32, kPoint16, kRuns, kBlend8, kBlend16, kBlend32 };
std::vector<Variant> variantsOf(size_t slots, double largest_sum_n) {
  const double scale_n = scaleOf(largest_sum_n);
  return {pointVariant("point-centric, 32 bit state", StateFormat::kFloat32),
          pointVariant("point-centric, 16 bit state", StateFormat::kFloat16),
          edgeVariant("edge-centric, runs"),
          blendVariant(BlendFormat::kFixed8, slots, scale_n),
          blendVariant(BlendFormat::kFloat16, slots, scale_n),
          blendVariant(BlendFormat::kFloat32, slots, scale_n)};
}

Misfit errorOf(const GwNetwork& network, const Field& measured, const Field& truth) {
  return misfit(network.model, {{measured}, 0}, {{truth}, 0});
}

/// Rounds to float32 as in the kernels, so that only their arithmetic is compared; 16-bit states round once more.
Field asFloats(const Field& field) {
  Field out;
  for (const Vector3d& v : field) out.emplace_back(v.cast<float>().cast<double>());
  return out;
}

void compareForces(Report& report, const GwNetwork& network, Table& table) {
  report.stage("forces, " + network.name);
  const Field u_m = asFloats(deformed(network));
  const Field truth_n = ReferenceLattice(network.model).elasticForces(u_m);
  const std::vector<Variant> variants = variantsOf(network.slots(), largestSum_n(network, u_m));
  std::vector<Field> forces_n;
  for (const Variant& variant : variants) {
    GwKernels kernels(network, variant.state);
    kernels.start(u_m);
    const BlendTarget* target = variant.gather(kernels);
    forces_n.push_back(target ? target->forces() : kernels.forces());
    const Misfit error = errorOf(network, forces_n.back(), truth_n);
    table.add({network.name, static_cast<double>(network.nodes()), variant.name, error.max, error.rms});
  }
  report.checkAtMost(network.name + ": point- against " + variants[kRuns].name + ", largest difference of a force",
                     errorOf(network, forces_n[kRuns], forces_n[kPoint32]).max, kAgreement);
  report.checkAtMost(network.name + ": blending into 32 bit floats, error of a force",
                     errorOf(network, forces_n[kBlend32], truth_n).max, kBlending32);
}

/// Displacements of the true motion at checkpoints, and the largest sum that a target must represent.
struct TrueMotion {
  GwMotion motion;
  std::vector<int> substeps;  ///< [checkpoints] number of substeps
  std::vector<Field> u_m;     ///< [checkpoints] displacements
  double largest_sum_n = 0;
};

TrueMotion trueMotion(const GwNetwork& network, const std::vector<int>& substeps) {
  TrueMotion out;
  out.substeps = substeps;
  // Rounded as in the kernels.
  out.motion.dt_s = static_cast<double>(static_cast<float>(kDtFraction * safeTimeStep(network.model)));
  out.motion.gravity_m_per_s2 = kGravity_m_per_s2.cast<float>().cast<double>();
  ReferenceSolver solver(network.model, out.motion.gravity_m_per_s2, out.motion.dt_s);
  int done = 0;
  for (int until : substeps) {
    for (; done < until; ++done) {
      solver.substep();
      if (done % 10 == 0) out.largest_sum_n = std::max(out.largest_sum_n, largestSum_n(network, solver.u_m));
    }
    out.u_m.push_back(solver.u_m);
  }
  return out;
}

/// Returns [checkpoints] errors.
std::vector<Misfit> errorsOf(const GwNetwork& network, const TrueMotion& truth, const Variant& variant) {
  GwKernels kernels(network, variant.state);
  kernels.start(Field(network.slots(), Vector3d::Zero()));
  std::vector<Misfit> out;
  int done = 0;
  for (size_t c = 0; c < truth.substeps.size(); ++c) {
    for (; done < truth.substeps[c]; ++done) kernels.integrate(truth.motion, variant.gather(kernels));
    out.push_back(errorOf(network, kernels.displacements(), truth.u_m[c]));
  }
  return out;
}

void compareMotions(Report& report, const GwNetwork& network, const std::vector<int>& substeps, Table& table) {
  report.stage("motion, " + network.name + ", float64");
  const TrueMotion truth = trueMotion(network, substeps);
  double worst = 0;  // of methods that use 32-bit floats throughout
  const std::vector<Variant> variants = variantsOf(network.slots(), kHeadroom * truth.largest_sum_n);
  Plot plot{"Error of u over its largest, " + network.name,
            "substeps of dt_safe/2",
            "largest error / largest u",
            true,
            true,
            {}};
  for (size_t w = 0; w < variants.size(); ++w) {
    const Variant& variant = variants[w];
    report.stage("motion, " + network.name + ", " + variant.name);
    const std::vector<Misfit> errors = errorsOf(network, truth, variant);
    Series series{variant.name, {}, {}};
    for (size_t c = 0; c < errors.size(); ++c) {
      const double time_s = substeps[c] * truth.motion.dt_s;
      table.add({network.name, static_cast<double>(network.nodes()), variant.name, substeps[c], time_s,
                 largestNorm(truth.u_m[c]), errors[c].max, errors[c].rms});
      series.x.push_back(substeps[c]);
      series.y.push_back(errors[c].max);
      if (w != kPoint16 && w != kBlend8 && w != kBlend16) worst = worse(worst, errors[c].max);
    }
    plot.series.push_back(std::move(series));
  }
  report.add(plot, "motion_" + network.name);
  report.checkAtMost(network.name + ": motion in 32 bit floats with any method, largest error of u", worst, kMotion);
}

}  // namespace

void measureForceErrors(Report& report) {
  Table table("Forces of a deformed state against float64, over the largest of them",
              {{"mesh"}, {"nodes", "", 8}, {"way"}, {"largest error", "", 3}, {"rms error", "", 3}});
  const uint32_t edge = report.isShort() ? 48 : 128;
  compareForces(report, regularSheet(edge), table);
  compareForces(report, irregularSheet(edge), table);
  report.add(table, "force_errors");
}

void measureMotionErrors(Report& report) {
  Table table("Motion from rest under gravity against float64 with the same substep, over the largest u",
              {{"scene"},
               {"nodes", "", 8},
               {"way"},
               {"substeps", "", 6},
               {"t", "s", 3},
               {"largest u", "m", 3},
               {"largest error", "", 3},
               {"rms error", "", 3}});
  const std::vector<int> substeps =
      report.isShort() ? std::vector<int>{10, 30, 100} : std::vector<int>{10, 30, 100, 300, 1000, 3000};
  compareMotions(report, hangingCloth(report.isShort() ? 16 : 32), substeps, table);
  compareMotions(report, hangingHeart(report.isShort() ? 600 : 1500), substeps, table);
  report.add(table, "motion_errors");
}

}  // namespace viscera::bench
