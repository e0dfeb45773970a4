// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/validate/validate_suite.h"

#include <algorithm>
#include <cmath>

#include "bench/suites/validate/measured_curves.h"
#include "bench/suites/validate/validate_trials.h"

namespace viscera::bench {

namespace {

constexpr double kFitFrom = 0.05, kFitTo = 0.1;       // range of strains for fitting E
constexpr double kForetold[] = {0.2, 0.3, 0.5};       // strains that are predicted
constexpr double kSure = 0.3;                         // largest strain at which errors are limited by kMostError
constexpr double kMostError = 0.1;                    // relative, of stress
constexpr double kFitStep = 0.01;                     // of strain
constexpr double kRubber = 0.49, kNearRubber = 0.45;  // Poisson's ratios: the largest in scenes, and a lower one
constexpr double kSneddonMost = 0.15;                 // relative, of force; 4 spacings are a coarse sphere
constexpr double kInPercent = 100;

double cylinderSpacing_m(const Report& report) {
  return report.isShort() ? 0.005 : 0.003;
}

/// Fits stress = E f(strain) by least squares.
double fittedYoung(const MeasuredCurve& measured, const Compression& model) {
  double both = 0, square = 0;
  for (double strain = kFitFrom; strain < kFitTo + kFitStep / 2; strain += kFitStep) {
    both += model.at(strain) * measured.at(strain);
    square += model.at(strain) * model.at(strain);
  }
  return both / square;
}

void compression(Report& report) {
  std::vector<Column> columns = {{"nu"}, {"spacing", "m"}};
  const double strains[] = {0.01, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5};
  for (const double strain : strains) columns.push_back({"at " + Cell(strain).text(2), "", 4});
  Table table("A cylinder of 50 x 30 mm between frictionless plates: engineering stress over E times strain", columns);
  struct Pressed {
    double nu, spacing_m;
  };
  const double usual_m = cylinderSpacing_m(report);
  std::vector<Pressed> specimens = {{kNearRubber, usual_m}, {kRubber, usual_m}};
  if (!report.isShort())
    specimens.insert(specimens.end(), {{0.25, usual_m}, {kRubber, 0.005}, {kNearRubber, 0.002}, {kRubber, 0.002}});
  for (const auto& [nu, spacing_m] : specimens) {
    report.stage("compression, nu " + Cell(nu).text(2) + ", spacing " + Cell(spacing_m).text(2) + " m");
    const Compression found = compressedCylinder(nu, spacing_m, strains[std::size(strains) - 1]);
    std::vector<Cell> row = {nu, spacing_m};
    for (const double strain : strains) row.emplace_back(found.at(strain) / strain);
    table.add(row);
  }
  report.add(table, "compression");
}

/// Returns the columns of the predicted strains.
std::vector<Column> foretoldColumns(double nu) {
  std::vector<Column> out = {{"E, nu " + Cell(nu).text(2), "kPa", 4}};
  for (const double strain : kForetold)
    out.push_back({"error at " + Cell(strain).text(2) + ", nu " + Cell(nu).text(2), "%", 3});
  return out;
}

/// Predicts stresses. @return largest error up to kSure
double foretell(const MeasuredCurve& measured, const Compression& model, std::vector<Cell>& row) {
  const double young_pa = fittedYoung(measured, model);
  row.emplace_back(young_pa / 1000);
  double worst = 0;
  for (const double strain : kForetold) {
    const double error = young_pa * model.at(strain) / measured.at(strain) - 1;
    row.emplace_back(kInPercent * error);
    if (strain <= kSure) worst = std::max(worst, std::abs(error));
  }
  return worst;
}

void silicones(Report& report) {
  if (report.data().empty()) {
    report.note("silicones: skipped, because there is no --data FILE of measured curves (docs/verification.md)\n");
    return;
  }
  const double most = *std::max_element(std::begin(kForetold), std::end(kForetold));
  const std::vector<MeasuredCurve> materials = readMeasuredCurves(report.data(), most);
  std::vector<Column> columns = {{"material"}};
  std::vector<Compression> models;
  for (const double nu : {kRubber, kNearRubber}) {
    report.stage("cylinder, nu " + Cell(nu).text(2));
    models.push_back(compressedCylinder(nu, cylinderSpacing_m(report), most));
    const std::vector<Column> of = foretoldColumns(nu);
    columns.insert(columns.end(), of.begin(), of.end());
  }
  Table table("Stress of measured materials predicted by scenes with E fitted on strains 0.05 to 0.1", columns);
  Plot plot{"Compression of " + materials[0].name, "strain", "engineering stress [Pa]", false, false, {}};
  double worst = 0;
  for (const MeasuredCurve& measured : materials) {
    std::vector<Cell> row = {measured.name};
    worst = std::max(worst, foretell(measured, models[0], row));
    foretell(measured, models[1], row);
    table.add(row);
  }
  Series simulated{"scene, nu 0.49", models[0].strain, {}},
      known{"measured", materials[0].strain, materials[0].stress_pa, Series::Style::kPoints};
  for (const double stress : models[0].stress_over_e)
    simulated.y.push_back(stress * fittedYoung(materials[0], models[0]));
  plot.series = {simulated, known};
  report.add(table, "silicones");
  report.add(plot, "silicones");
  report.checkAtMost("silicones, nu 0.49: largest error of stress at strains of 0.2 and 0.3", worst, kMostError);
}

/// Returns the force on a sphere in a half space by Sneddon, with the contact on the sphere, relative to Hertz's, with
/// the contact on a paraboloid.
/// @param depth  over the radius
double sneddonOverHertz(double depth) {
  double low = 0, high = 1;  // radius of the contact over that of the sphere
  for (int i = 0; i < 60; ++i) {
    const double a = (low + high) / 2;
    (a * std::atanh(a) < depth ? low : high) = a;
  }
  return ((1 + low * low) * std::atanh(low) - low) / (4.0 / 3 * std::pow(depth, 1.5));
}

void sphere(Report& report) {
  report.stage("sphere on a block");
  const std::vector<double> depths =
      report.isShort() ? std::vector<double>{0.2, 0.5} : std::vector<double>{0.1, 0.2, 0.3, 0.5, 0.7, 1, 1.25, 1.5};
  const int radius = report.isShort() ? 3 : 4;
  const SpherePress found = pressedSphere(kNearRubber, radius, depths);
  Table table(
      "A sphere of " + std::to_string(radius) + " spacings in a block of 10 x 10 x 5 radii, nu 0.45",
      {{"D/R", "", 3}, {"F/F_Hertz", "", 3}, {"Sneddon/Hertz", "", 3}, {"F/F_Sneddon", "", 3}, {"exponent", "", 3}});
  double worst = 0;
  for (size_t i = 0; i < found.depth_over_r.size(); ++i) {
    const double depth = found.depth_over_r[i], over = found.over_hertz[i], sneddon = sneddonOverHertz(depth);
    std::vector<Cell> row = {depth, over, sneddon, over / sneddon, ""};
    if (i > 0) row[4] = 1.5 + std::log(over / found.over_hertz[i - 1]) / std::log(depth / found.depth_over_r[i - 1]);
    table.add(row);
    worst = std::max(worst, std::abs(over / sneddon - 1));
  }
  report.add(table, "sphere");
  report.checkAtMost("sphere: largest error of force against Sneddon's", worst, kSneddonMost);
}

}  // namespace

void validateSuite(Report& report) {
  measureParts(report, {{"compression", compression}, {"silicones", silicones}, {"sphere", sphere}});
}

}  // namespace viscera::bench
