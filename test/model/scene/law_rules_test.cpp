// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// material.law in a scene file: its default, and what it cannot be combined with.
#include <gtest/gtest.h>

#include <string>

#include "model/scene/feature_rules.h"
#include "viscera/math/error.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/scene.h"

using namespace viscera;

namespace {

Scene boxScene(const std::string& material, const std::string& more = "") {
  return parseScene(
      "bodies:\n  - {name: pad, source: box, box_size_m: [0.02, 0.02, 0.02], spacing_m: 0.005, material: {" + material +
          "}" + more + "}\n",
      "pad.yaml");
}

Scene withPd(Scene scene) {
  scene.solver.integrator = Integrator::kPd;
  return scene;
}

Law builtOf(const Scene& scene) {
  return buildModel(scene).bodies[0].material.law;
}

std::string faultOf(const Scene& scene) {
  try {
    requireFeatures(scene);
    buildModel(scene);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::string faultOf(const std::string& material, const std::string& more = "") {
  try {
    return faultOf(boxScene(material, more));
  } catch (const Error& error) {
    return error.what();
  }
}

bool names(const std::string& fault, const std::string& what) {
  return fault.find(what) != std::string::npos;
}

}  // namespace

TEST(LawRules, LatticesThatLeapfrogStepsAreNeoHookeanUnlessAskedOtherwise) {
  EXPECT_EQ(builtOf(boxScene("")), Law::kNeoHookean);
  EXPECT_EQ(builtOf(boxScene("law: springs")), Law::kSprings);
  EXPECT_EQ(builtOf(boxScene("weights: paper")), Law::kSprings);
  EXPECT_EQ(builtOf(boxScene("", ", structure: explicit")), Law::kSprings);
  EXPECT_EQ(builtOf(withPd(boxScene(""))), Law::kSprings);
}

TEST(LawRules, WhatItDoesNotGoWithIsNamed) {
  EXPECT_TRUE(names(faultOf("law: neo_hookean, weights: paper"), "cannot be combined with material.law: neo_hookean"));
  EXPECT_TRUE(names(faultOf("law: neo_hookean", ", structure: explicit"), "structure lattice"));
  EXPECT_TRUE(names(faultOf("law: springs, stiffening: 2"), "material.stiffening needs material.law: neo_hookean"));
  EXPECT_NE(faultOf(withPd(boxScene("stiffening: 2"))), "") << "pd has springs";
  EXPECT_TRUE(names(faultOf("law: springs, walls: rows"), "material.walls: rows needs material.law: neo_hookean"));
  EXPECT_TRUE(names(faultOf("walls: rows", ", structure: explicit"), "structure lattice"));
  EXPECT_TRUE(names(faultOf("walls: rows, prestress: {strain: 0.1}"),
                    "material.walls: rows cannot be combined with material.prestress"));
  EXPECT_NE(faultOf(withPd(boxScene("walls: rows"))), "") << "pd has springs";
  EXPECT_EQ(faultOf("walls: rows"), "");
  EXPECT_TRUE(names(faultOf(withPd(boxScene("law: neo_hookean"))),
                    "material.law: neo_hookean needs solver.integrator leapfrog, not pd"));
}

TEST(LawRules, SpringsHaveNoPoissonsRatioOfTheirOwn) {
  const std::string nu = "poisson_ratio: 0.3", part = ", parts: [{part: box, poisson_ratio: 0.3}]";
  EXPECT_EQ(faultOf(nu), "");
  EXPECT_EQ(faultOf("", part), "");
  EXPECT_EQ(faultOf("law: springs, poisson_ratio: 0.25"), "");
  for (const std::string& fault :
       {faultOf("law: springs, " + nu), faultOf("law: springs", part), faultOf("weights: paper, " + nu),
        faultOf(nu, ", structure: explicit"), faultOf("", ", structure: explicit" + part),
        faultOf(withPd(boxScene(nu))), faultOf(withPd(boxScene("", part)))}) {
    EXPECT_TRUE(names(fault, "poisson_ratio")) << fault;
    EXPECT_TRUE(names(fault, "material.law: neo_hookean")) << fault;
  }
}

/// Each gives one error, which says what to do instead.
TEST(LawRules, KeysOfWhatCorrectedSpringsWereRemoved) {
  for (const std::string key : {"cells: moments", "cells: springs", "thin_walls: true"}) {
    const std::string fault = faultOf(key);
    const std::string name = key.substr(0, key.find(':'));
    EXPECT_TRUE(names(fault, "pad.yaml:2")) << fault;
    EXPECT_TRUE(names(fault, "'bodies[0].material." + name + "' was removed: ")) << fault;
    EXPECT_TRUE(names(fault, "material.law: neo_hookean")) << fault;
    EXPECT_EQ(fault.find('\n'), std::string::npos) << fault;
  }
}
