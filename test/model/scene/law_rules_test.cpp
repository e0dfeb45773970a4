// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// material.law in a scene file: what it is where nothing is said, and what it does not go with.
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

Law builtOf(const Scene& scene) {
  return buildModel(scene).bodies[0].material.law;
}

std::string faultOf(const std::string& material, const std::string& more = "") {
  try {
    const Scene scene = boxScene(material, more);
    requireFeatures(scene);
    buildModel(scene);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

bool names(const std::string& fault, const std::string& what) {
  return fault.find(what) != std::string::npos;
}

}  // namespace

TEST(LawRules, LatticesThatLeapfrogStepsAreNeoHookeanUnlessAskedOtherwise) {
  EXPECT_EQ(builtOf(boxScene("")), Law::kNeoHookean);
  EXPECT_EQ(builtOf(boxScene("law: springs")), Law::kSprings);
  EXPECT_EQ(builtOf(boxScene("cells: moments")), Law::kSprings);
  EXPECT_EQ(builtOf(boxScene("cells: springs")), Law::kSprings);
  EXPECT_EQ(builtOf(boxScene("weights: paper")), Law::kSprings);
  EXPECT_EQ(builtOf(boxScene("thin_walls: true")), Law::kSprings);
  EXPECT_EQ(builtOf(boxScene("", ", structure: explicit")), Law::kSprings);
  Scene pd = boxScene("");
  pd.solver.integrator = Integrator::kPd;
  EXPECT_EQ(builtOf(pd), Law::kSprings);
}

TEST(LawRules, WhatItDoesNotGoWithIsNamed) {
  for (const char* with : {"cells: springs", "weights: paper", "thin_walls: true"})
    EXPECT_TRUE(names(faultOf(std::string("law: neo_hookean, ") + with), "does not go with material.law: neo_hookean"))
        << with;
  EXPECT_TRUE(names(faultOf("law: neo_hookean", ", structure: explicit"), "structure lattice"));
  EXPECT_TRUE(names(faultOf("law: springs, stiffening: 2"), "material.stiffening needs material.law: neo_hookean"));
  Scene stiffening = boxScene("stiffening: 2");
  stiffening.solver.integrator = Integrator::kPd;  // which has springs
  EXPECT_THROW(requireFeatures(stiffening), SceneError);
  Scene pd = boxScene("law: neo_hookean");
  pd.solver.integrator = Integrator::kPd;
  try {
    requireFeatures(pd);
    ADD_FAILURE() << "taken";
  } catch (const Error& error) {
    EXPECT_TRUE(names(error.what(), "material.law: neo_hookean needs solver.integrator leapfrog, not pd"))
        << error.what();
  }
}
