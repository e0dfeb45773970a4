// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibration/adaptive_resolution.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "math/number_text.h"
#include "viscera/math/error.h"
#include "viscera/model/body/spacing_choice.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Returns a length in millimetres with three digits.
std::string inMillimetres(double length_m) {
  TextOut out;
  out.precision(3);
  out << 1e3 * length_m << " mm";
  return out.str();
}

std::string asFactor(double factor) {
  TextOut out;
  out.precision(2);
  out << factor << " of real time over " << AdaptiveResolution::kReadings << " s";
  return out.str();
}

}  // namespace

void AdaptiveResolution::begin(const Scene& asked, const Scene& chosen) {
  const std::lock_guard<std::mutex> lock(mutex_);
  bodies_ = autoBodies(asked);
  for (size_t b = 0; b < asked.bodies.size(); ++b) {
    if (!asked.bodies[b].spacing_note.empty()) bodies_.push_back(b);  // from coarser()
  }
  spacing_m_ = bodies_.empty() ? 0 : chosen.bodies[bodies_[0]].spacing_m;
  wanted_factor_ = std::max(1.0, chosen.solver.real_time_factor);
  factors_.clear();
  said_ = false;
}

bool AdaptiveResolution::isSlow() const {
  return factors_.size() == kReadings && *std::max_element(factors_.begin(), factors_.end()) < kSlow;
}

double AdaptiveResolution::wanted_m() const {
  return spacing_m_ * std::max(kLeast, std::pow(wanted_factor_ / std::max(mean(factors_), 1e-3), 0.25));
}

std::string AdaptiveResolution::record(double real_time_factor, uint64_t tick) {
  const std::lock_guard<std::mutex> lock(mutex_);
  said_ = said_ && tick >= tick_;
  tick_ = tick;
  if (factors_.size() == kReadings) factors_.erase(factors_.begin());
  factors_.push_back(real_time_factor);
  if (bodies_.empty()) return "";
  if (!isSlow()) {
    said_ = said_ && real_time_factor < kSlow;
    return "";
  }
  if (said_) return "";
  said_ = true;
  return "spacing_m: auto: " + inMillimetres(spacing_m_) + " is too fine for the present load of the machine, " +
         asFactor(mean(factors_)) + "; " + inMillimetres(wanted_m()) +
         " would run in real time; call service coarsen to switch to it";
}

Scene AdaptiveResolution::coarser(const Scene& asked) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (bodies_.empty()) throw Error("no body of the scene has spacing_m: auto");
  if (factors_.size() < kReadings) throw Error("the session has not run for " + std::to_string(kReadings) + " s yet");
  if (!isSlow()) throw Error("the session runs in real time: " + asFactor(mean(factors_)));
  Scene out = asked;
  for (const size_t b : bodies_) out.bodies[b].auto_spacing = true;
  const double spacing_m = std::min(wanted_m(), UndividedBodies(out).thinnestWall_m());
  if (spacing_m < kLeast * spacing_m_ * (1 - 1e-9))
    throw Error("lattices are " + inMillimetres(spacing_m_) +
                " fine, and their thinnest walls do not allow much coarser ones");
  for (const size_t b : bodies_) {
    out.bodies[b].auto_spacing = false;
    out.bodies[b].spacing_m = spacing_m;
    out.bodies[b].spacing_note = "spacing_m: auto: " + inMillimetres(spacing_m) + " instead of " +
                                 inMillimetres(spacing_m_) + ", which ran at " + asFactor(mean(factors_));
  }
  return out;
}

}  // namespace viscera
