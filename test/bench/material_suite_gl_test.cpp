// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>

#include "support/process.h"
#include "support/source_folder.h"
#include "support/text.h"

#ifdef VISCERA_HAS_COMMAND

namespace viscera {
namespace {

using namespace test;

constexpr const char* kNoDevice = "__EGL_VENDOR_LIBRARY_FILENAMES=/dev/null";

void expectMaterialLimits(const std::string& backend) {
  const TemporaryFolder folder;
  const Ending ending = runProgram(
      kCommand, {"bench", "material", "--short", "--strict", "--backend", backend, "--out", folder.file("out")});
  EXPECT_EQ(ending.status, 0) << ending.out << ending.err;
  EXPECT_TRUE(says(ending.out, {"viscera bench material --short, on ", "Checks of material", " checks, 0 missed"}));
  for (const char* stem : {"tension", "stretch", "chains", "waves", "cantilever", "hertz", "probe"}) {
    for (const char* extension : {".csv", ".png"}) {
      EXPECT_TRUE(std::filesystem::exists(folder.file(std::string("out/material_") + stem + extension)))
          << stem << extension;
    }
  }
  for (const char* stem : {"walls", "circle", "slopes", "stack"}) {
    EXPECT_TRUE(says(readFile(folder.file(std::string("out/material_") + stem + ".csv")), {backend})) << stem;
  }
  // Every kind of measurement has reported its result.
  const std::string checks = readFile(folder.file("out/material_checks.csv"));
  EXPECT_TRUE(says(checks, {"tension", "finite stretch", "chains", "plane waves", "cantilever", "Hertz", "probe"}));
  EXPECT_TRUE(says(checks, {"tension, cell weights, forces of " + backend, "finite stretch, forces of " + backend,
                            backend + ": chains", backend + ": plane waves", backend + ": probe at rest"}))
      << checks;
}

TEST(MaterialSuite, ShortFormReachesEveryLimitAndLeavesTablesAndPlots) {
  expectMaterialLimits("cpu");
}

TEST(MaterialSuite, ReachesEveryLimitOnTheGpu) {
  expectMaterialLimits("gpu");
}

TEST(MaterialSuite, RefusesTheGpuWithoutADevice) {
  const TemporaryFolder folder;
  const Ending refused =
      runProgram(kCommand, {"bench", "material", "--short", "--backend", "gpu", "--out", folder.path()}, {kNoDevice});
  EXPECT_EQ(refused.status, 1);
  EXPECT_TRUE(says(refused.err, {"viscera: error:", "EGL"})) << refused.err;
}

TEST(MaterialSuite, RefusesAFolderThatIsAFile) {
  const TemporaryFolder folder;
  const Ending ending =
      runProgram(kCommand, {"bench", "material", "--short", "--out", folder.write("file", "") + "/x"});
  EXPECT_EQ(ending.status, 1);
  EXPECT_TRUE(says(ending.err, {"viscera: error: --out"}));
}

}  // namespace
}  // namespace viscera

#endif  // VISCERA_HAS_COMMAND
