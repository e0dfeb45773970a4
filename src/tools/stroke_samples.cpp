// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/stroke_samples.h"

#include <cmath>
#include <limits>
#include <locale>
#include <sstream>

#include "math/number_text.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

constexpr double kFarthest_m = 100;      ///< as for way-points
constexpr double kUnitTolerance = 1e-6;  ///< of a quaternion's length: it is used as recorded, not normalised
constexpr const char* kAccepted =
    "a sample must be: tick x y z qx qy qz qw button1 button2, and for jaws their opening, with a tick from 1 on that "
    "is greater than the one before, "
    "-100 .. 100 m, a quaternion of length 1, buttons 0 or 1, an opening of 0 .. 3.1416 rad";

/// Reads one line. @returns whether it is a sample
bool read(std::istringstream& in, Stroke::Sample& sample) {
  double at[7];
  int button1 = 0, button2 = 0;
  in >> sample.tick;
  for (double& value : at) in >> value;
  in >> button1 >> button2;
  if (in.fail()) return false;
  if (in >> std::ws; !in.eof()) {
    in >> sample.jaw_rad;
    std::string rest;
    if (in.fail() || !(sample.jaw_rad >= 0 && sample.jaw_rad <= kWidestJaw_rad) || in >> rest) return false;
  }
  sample.pose.position_m = {at[0], at[1], at[2]};
  sample.pose.orientation = Quaterniond(at[6], at[3], at[4], at[5]);
  sample.button1 = button1 == 1;
  sample.button2 = button2 == 1;
  return sample.pose.position_m.cwiseAbs().maxCoeff() <= kFarthest_m &&
         std::abs(sample.pose.orientation.norm() - 1) <= kUnitTolerance && (button1 & ~1) == 0 && (button2 & ~1) == 0;
}

}  // namespace

std::string sampleLine(const Stroke::Sample& sample) {
  TextOut out;
  out.imbue(std::locale::classic());
  out.precision(std::numeric_limits<double>::max_digits10);
  const Vector3d& p = sample.pose.position_m;
  const Quaterniond& q = sample.pose.orientation;
  out << sample.tick;
  for (const double value : {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}) out << ' ' << value;
  out << ' ' << sample.button1 << ' ' << sample.button2;
  if (sample.jaw_rad >= 0) out << ' ' << sample.jaw_rad;
  out << '\n';
  return out.str();
}

std::vector<Stroke::Sample> parseSamples(const std::string& text, const std::string& file, int first_line) {
  std::vector<Stroke::Sample> samples;
  TextIn lines(text), words;
  words.imbue(std::locale::classic());
  int number = first_line;
  for (std::string line; std::getline(lines, line); ++number) {
    words.clear();
    words.str(line);
    Stroke::Sample sample;
    const uint64_t before = samples.empty() ? 0 : samples.back().tick;
    if (line.find('-') == 0 || !read(words, sample) || sample.tick <= before)
      throw StrokesError(file + ":" + std::to_string(number) + ": " + kAccepted + "; found '" + line.substr(0, 200) +
                         "'");
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace viscera
