// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/steps/multigrid_stages.h"

#include <cmath>

#include "layout/bindings.h"
#include "solver/multigrid/steps/step_rules.h"

namespace viscera {

using multigrid::Energy;
using multigrid::Stage;

MultigridStages::MultigridStages(const FeatureSet& features, const LatticeBuffers& buffers)
    : features_(features),
      buffers_(buffers),
      own_(features, buffers),
      coarse_(features, features.tools || features.obstacles > 0),
      begin_(compiled("multigrid_begin.comp")),
      stage_(compiled("multigrid_stage.comp")),
      increment_(compiled("multigrid_increment.comp")),
      place_(compiled("multigrid_increment.comp", {"PLACE"})),
      linearise_(compiled("multigrid_linearise.comp")),
      product_(compiled("multigrid_product.comp")),
      smooth_(compiled("multigrid_smooth.comp")),
      dot_(compiled("multigrid_vectors.comp", {"DOT"})),
      direction_(compiled("multigrid_vectors.comp", {"DIRECTION"})),
      advance_(compiled("multigrid_vectors.comp", {"ADVANCE"})),
      balance_(compiled("multigrid_vectors.comp", {"BALANCE"})),
      mask_(compiled("multigrid_vectors.comp", {"MASK"})),
      sum_(compiled("multigrid_sum.comp")),
      tame_(compiled("multigrid_tame.comp")),
      end_(compiled("multigrid_end.comp")) {
  if (!features.volume) return;
  cells_ = compiled("multigrid_cells.comp");
  cells_product_ = compiled("multigrid_cells.comp", {"PRODUCT"});
}

gpu::Program MultigridStages::compiled(const char* name, std::initializer_list<const char*> more) const {
  std::vector<std::string> defines = features_.defines();
  if (own_.touched.size()) defines.push_back("HELD");
  defines.insert(defines.end(), more.begin(), more.end());
  return gpu::Program::compute(name, defines);
}

void MultigridStages::setLevels(FindLevels find, double stiffest_n_per_m) {
  find_ = std::move(find);
  stiffest_n_per_m_ = stiffest_n_per_m;
}

void MultigridStages::beginStep(const Substep& step, bool fresh, MultigridTouchPass* touch) {
  step_ = step;
  fresh_ = fresh;
  touch_ = touch;
}

void MultigridStages::forgetTouched() {
  if (own_.touched.size()) own_.touched.clear();
}

void MultigridStages::use(const gpu::Program& program) const {
  program.use();
  setSubstep(program, buffers_, step_);
  program.set("slot_count", static_cast<uint32_t>(buffers_.store.slot_count));
}

void MultigridStages::run(const gpu::Program& program, size_t count) const {
  program.set("active_count", static_cast<uint32_t>(count));
  gpu::Program::dispatch(count, features_.group_size);
  gpu::Program::storageBarrier();
}

void MultigridStages::runNodes(const gpu::Program& program) const {
  run(program, buffers_.store.active_count);
}

/// @param summed  invocations of the kernel that has left partial sums
void MultigridStages::sum(uint32_t first_row, uint32_t rows, size_t summed, bool first) const {
  sum_.use();
  sum_.set("count", static_cast<uint32_t>(launchedGroups(summed, features_.group_size)));
  sum_.set("first_row", first_row);
  sum_.set("first_iteration", first ? 1u : 0u);
  gpu::Program::dispatch(size_t{rows} * features_.group_size, features_.group_size);
  gpu::Program::storageBarrier();
}

void MultigridStages::begin(const Stage& stage) {
  of_ = stage;
  levels_ = find_(stage);
}

void MultigridStages::endStep() {
  use(end_);
  runNodes(end_);
}

/// Forces and tangents where place and speed are, and the sums of energies.
void MultigridStages::linearise() const {
  if (cells_) {
    use(*cells_);
    run(*cells_, buffers_.store.cells.size());
    sum(layout::kSumsCells, 1, buffers_.store.cells.size());
  }
  use(linearise_);
  linearise_.set("inertia", static_cast<float>(of_.inertia_per_s2));
  linearise_.set("rate", static_cast<float>(of_.rate_per_s));
  runNodes(linearise_);
  sum(layout::kSumsSprings, 1, buffers_.store.active_count);
}

Energy MultigridStages::energy() const {
  const MultigridBuffers::Sums& balance = read_.rows[layout::kSumsBalance];
  Energy out;
  out.kinetic_j = balance[2];
  out.sum_j = balance[2] + read_.rows[layout::kSumsSprings][0] - balance[3];
  if (cells_) out.sum_j += read_.rows[layout::kSumsCells][0];
  return out;
}

Energy MultigridStages::start() {
  use(begin_);
  begin_.set("fresh", fresh_ ? 1u : 0u);
  runNodes(begin_);
  linearise();
  use(mask_);
  mask_.set("inertia", static_cast<float>(of_.inertia_per_s2));
  runNodes(mask_);
  sum(layout::kSumsBalance, 2, buffers_.store.active_count);
  read_ = own_.read();
  return energy();
}

void MultigridStages::beginStage(uint32_t stage) {
  use(stage_);
  stage_.set("stage", stage);
  stage_.set("inertia", static_cast<float>(of_.inertia_per_s2));
  stage_.set("rate", static_cast<float>(of_.rate_per_s));
  stage_.set("gamma_of", static_cast<float>(multigrid::kGamma));
  stage_.set("of_middle", static_cast<float>(multigrid::kOfMiddle));
  stage_.set("of_start", static_cast<float>(multigrid::kOfStart));
  stage_.set("second_s", static_cast<float>(multigrid::kSecond * static_cast<double>(step_.dt_s)));
  runNodes(stage_);
}

void MultigridStages::setShare(double share) {
  if (touch_) touch_->setShare(share);
}

MultigridStages::Balance MultigridStages::balance(bool /*tangent*/) {
  if (touch_) touch_->place(buffers_, step_);
  use(place_);
  place_.set("rate", static_cast<float>(of_.rate_per_s));
  runNodes(place_);
  linearise();
  use(balance_);
  balance_.set("inertia", static_cast<float>(of_.inertia_per_s2));
  runNodes(balance_);
  if (touch_) touch_->press(buffers_, step_);
  use(mask_);
  mask_.set("inertia", static_cast<float>(of_.inertia_per_s2));
  runNodes(mask_);
  sum(layout::kSumsBalance, 2, buffers_.store.active_count);
  read_ = own_.read();
  const MultigridBuffers::Sums& row = read_.rows[layout::kSumsBalance];
  Balance out;
  out.residual_n = std::sqrt(row[0]);
  out.noise_n = multigrid::kFloatDisplacement * stiffest_n_per_m_ * std::sqrt(row[1]);
  out.changed = touch_ && read_.scalars.changed != 0;
  return out;
}

double MultigridStages::lag_j() const {
  return read_.rows[layout::kSumsTouch][0];
}

double MultigridStages::given_j() const {
  return touch_ ? read_.rows[layout::kSumsTouch][1] : 0;
}

void MultigridStages::multiply(uint32_t x, uint32_t y, uint32_t base, bool subtract) const {
  if (cells_product_) {
    use(*cells_product_);
    cells_product_->set("x_vector", x);
    run(*cells_product_, buffers_.store.cells.size());
  }
  use(product_);
  product_.set("x_vector", x);
  product_.set("y_vector", y);
  product_.set("base_vector", base);
  product_.set("subtract", subtract ? 1u : 0u);
  runNodes(product_);
}

void MultigridStages::smooth(uint32_t r, float a, float b, bool first) const {
  use(smooth_);
  smooth_.set("r_vector", r);
  smooth_.set("a", a);
  smooth_.set("b", b);
  smooth_.set("first", first ? 1u : 0u);
  runNodes(smooth_);
}

/// The correction, one V-cycle of the residual, as multigrid::Hierarchy has it.
void MultigridStages::cycle() const {
  const multigrid::Chebyshev cheb(levels_.largest);
  const auto subtract = [&](uint32_t base) { multiply(layout::kSystemChange, layout::kSystemWork, base, true); };
  smooth(layout::kSystemResidual, 0, cheb.first, true);
  subtract(layout::kSystemResidual);
  smooth(layout::kSystemWork, cheb.again, cheb.second, false);
  if (levels_.levels->empty()) return;
  subtract(layout::kSystemWork);
  levels_.levels->correct(coarse_, buffers_.store.active_count, buffers_.store.slot_count);
  subtract(layout::kSystemWork);
  smooth(layout::kSystemWork, 0, cheb.first, false);
  subtract(layout::kSystemWork);
  smooth(layout::kSystemWork, cheb.again, cheb.second, false);
}

void MultigridStages::dot(uint32_t x, uint32_t y, uint32_t row, bool first) const {
  use(dot_);
  dot_.set("x_vector", x);
  dot_.set("y_vector", y);
  runNodes(dot_);
  sum(row, 1, buffers_.store.active_count, first);
}

multigrid::Iteration MultigridStages::iterate(bool first) {
  cycle();
  dot(layout::kSystemResidual, layout::kSystemCorrection, layout::kSumsRz, first);
  use(direction_);
  direction_.set("first", first ? 1u : 0u);
  runNodes(direction_);
  multiply(layout::kSystemDirection, layout::kSystemProduct, layout::kSystemProduct, false);
  dot(layout::kSystemDirection, layout::kSystemProduct, layout::kSumsCurvature, first);
  use(advance_);
  runNodes(advance_);
  sum(layout::kSumsLeft, 1, buffers_.store.active_count, first);
  const MultigridBuffers::Read read = own_.read();
  const double rz = read.rows[layout::kSumsRz][0], curvature = read.rows[layout::kSumsCurvature][0];
  if (!(rz > 0) || !(curvature > 0)) return {};
  return {true, rz * rz / curvature, std::sqrt(read.rows[layout::kSumsLeft][0])};
}

void MultigridStages::become(uint32_t what, float share) {
  use(increment_);
  increment_.set("becomes", what);
  increment_.set("share", share);
  runNodes(increment_);
}

void MultigridStages::addSolution(bool tame) {
  if (tame) {
    use(tame_);
    runNodes(tame_);
  }
  become(tame ? layout::kIncrementTamed : layout::kIncrementSolve, 1);
}

}  // namespace viscera
