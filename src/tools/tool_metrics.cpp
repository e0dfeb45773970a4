// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tool_metrics.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>

namespace viscera {

namespace {

using Complex = std::complex<double>;

constexpr double kPi = 3.14159265358979323846;
constexpr int kPadding = 4;               // the spectrum has 2^4 times as many points as the next power of two
constexpr double kHighest_hz = 10;        // upper limit of the spectrum
constexpr double kLeastAmplitude = 0.05;  // share of the largest amplitude

/// Transforms values in place; their number is a power of two.
void fourierTransform(std::vector<Complex>& values) {
  const size_t n = values.size();
  for (size_t i = 1, j = 0; i < n; ++i) {
    size_t bit = n / 2;
    for (; j & bit; bit /= 2) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(values[i], values[j]);
  }
  for (size_t span = 2; span <= n; span *= 2) {
    for (size_t k = 0; k < span / 2; ++k) {
      const Complex turn = std::polar(1.0, -2 * kPi * static_cast<double>(k) / static_cast<double>(span));
      for (size_t i = k; i < n; i += span) {
        const Complex a = values[i], b = turn * values[i + span / 2];
        values[i] = a + b;
        values[i + span / 2] = a - b;
      }
    }
  }
}

std::vector<double> speedsOf(const ToolTrack& track) {
  std::vector<double> out;
  for (size_t i = 1; i < track.positions_m.size(); ++i) {
    const bool known = track.tracked[i] && track.tracked[i - 1];
    out.push_back(known ? (track.positions_m[i] - track.positions_m[i - 1]).norm() * track.rate_hz : 0);
  }
  return out;
}

}  // namespace

double spectralArcLength(const std::vector<double>& speeds, double rate_hz) {
  size_t size = 1;
  while (size < speeds.size()) size *= 2;
  size <<= kPadding;
  std::vector<Complex> spectrum(speeds.begin(), speeds.end());
  spectrum.resize(size);
  fourierTransform(spectrum);
  std::vector<double> amplitudes;
  double largest = 0;
  const double step_hz = rate_hz / static_cast<double>(size);
  for (size_t i = 0; i < size; ++i) {
    const double amplitude = std::abs(spectrum[i]);
    largest = std::max(largest, amplitude);
    if (static_cast<double>(i) * step_hz <= kHighest_hz) amplitudes.push_back(amplitude);
  }
  if (!(largest > 0)) return 0;
  size_t first = amplitudes.size(), last = 0;
  for (size_t i = 0; i < amplitudes.size(); ++i) {
    amplitudes[i] /= largest;
    if (amplitudes[i] < kLeastAmplitude) continue;
    first = std::min(first, i);
    last = i;
  }
  double length = 0;
  for (size_t i = first; i < last; ++i)
    length += std::hypot(1 / static_cast<double>(last - first), amplitudes[i + 1] - amplitudes[i]);
  return -length;
}

double dimensionlessJerk(const std::vector<double>& speeds, double rate_hz) {
  double peak = 0, sum = 0;
  for (const double speed : speeds) peak = std::max(peak, std::abs(speed));
  if (!(peak > 0)) return 0;
  for (size_t i = 2; i < speeds.size(); ++i)
    sum += std::pow((speeds[i] - 2 * speeds[i - 1] + speeds[i - 2]) * rate_hz * rate_hz, 2);
  const double duration_s = static_cast<double>(speeds.size()) / rate_hz;
  return -std::pow(duration_s, 3) / (peak * peak) * sum / rate_hz;
}

double logDimensionlessJerk(const std::vector<double>& speeds, double rate_hz) {
  const double jerk = dimensionlessJerk(speeds, rate_hz);
  return jerk == 0 ? 0 : -std::log(std::abs(jerk));
}

void ToolTally::addPosition(bool tracked, const Vector3d& position_m) {
  if (tracked) {
    if (!first_m_) first_m_ = position_m;
    if (before_m_) sums_.path_m += (position_m - *before_m_).norm();
    sums_.time_s += 1 / rate_hz_;
    last_m_ = before_m_ = position_m;
  } else {
    before_m_.reset();
  }
}

void ToolTally::addForce(const Vector3d& force_n) {
  if (!force_n.allFinite() || force_n.isZero(0)) return;
  forces_ += 1;
  sums_.peak_force_n = std::max(sums_.peak_force_n, force_n.norm());
  sums_.force_time_ns += force_n.norm() / rate_hz_;
  force_sum_ += force_n;
  square_sum_ += force_n * force_n.transpose();
}

ToolMetrics ToolTally::metrics() const {
  ToolMetrics out = sums_;
  if (out.path_m > 0) out.economy = (*last_m_ - *first_m_).norm() / out.path_m;
  if (forces_ == 0) return out;
  out.mean_force_n = out.force_time_ns * rate_hz_ / forces_;
  const Vector3d mean = force_sum_ / forces_;
  const Matrix3d covariance = square_sum_ / forces_ - mean * mean.transpose();
  out.force_volume_n3 = 4.0 / 3.0 * kPi * std::sqrt(std::max(0.0, covariance.determinant()));
  return out;
}

ToolMetrics metricsOf(const ToolTrack& track) {
  ToolTally tally(track.rate_hz);
  for (size_t i = 0; i < track.positions_m.size(); ++i) tally.addPosition(track.tracked[i], track.positions_m[i]);
  for (const Vector3d& force : track.forces_n) tally.addForce(force);
  ToolMetrics out = tally.metrics();
  const std::vector<double> speeds = speedsOf(track);
  out.sparc = spectralArcLength(speeds, track.rate_hz);
  out.log_jerk = logDimensionlessJerk(speeds, track.rate_hz);
  return out;
}

}  // namespace viscera
