// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Section `ticks` of a saved state: every number must be possible for ticks of this scene, or it is refused by name.
#include <cstring>

#include "math/archive.h"
#include "support/random_state.h"
#include "support/solver_rig.h"
#include "viscera/math/error.h"

using namespace viscera;
using namespace viscera::test;

namespace {

/// A replacement value at an offset in the section.
struct Spoilt {
  size_t at;
  std::vector<char> bytes;
  const char* named;  ///< name in the error
};

template <class T>
Spoilt spoilt(size_t at, T value, const char* named) {
  Spoilt out{at, std::vector<char>(sizeof value), named};
  std::memcpy(out.bytes.data(), &value, sizeof value);
  return out;
}

/// Lists the values in the layout of TissueStepper::persist().
std::vector<Spoilt> spoiltTicks() {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
  constexpr size_t kSafe = 0, kLimit = 8, kStretch = 16, kStiffening = 24, kCalm = 40, kStrained = 44, kLast = 60,
                   kRecovers = 64, kRestarted = 65, kLast_s = 66, kReleasing = 74, kTime_s = 78;
  const auto byte = static_cast<uint8_t>(2);
  return {spoilt(kSafe, kNan, "stable substep"),   spoilt(kSafe, 0.0, "stable substep"),
          spoilt(kSafe, -1.0, "stable substep"),   spoilt(kLimit, kNan, "measured stable substep"),
          spoilt(kLimit, 1e9, "measured stable"),  spoilt(kStretch, -1.0, "stretch"),
          spoilt(kStretch, kInf, "stretch"),       spoilt(kStiffening, -1.0, "stiffening"),
          spoilt(kStiffening, kNan, "stiffening"), spoilt(kCalm, 0, "calm substeps"),
          spoilt(kCalm, 1 << 30, "calm substeps"), spoilt(kStrained, -5, "strained substeps"),
          spoilt(kStrained, 1 << 30, "strained"),  spoilt(kLast, 1 << 30, "substeps of the last tick"),
          spoilt(kLast, 0, "of the last tick"),    spoilt(kRecovers, byte, "flag"),
          spoilt(kRestarted, byte, "flag"),        spoilt(kLast_s, kNan, "last substep"),
          spoilt(kLast_s, 1.0, "last substep"),    spoilt(kReleasing, 1 << 30, "ticks after a cut"),
          spoilt(kTime_s, kInf, "time"),           spoilt(kTime_s, -1.0, "time")};
}

}  // namespace

TEST(SavedTicks, NumbersThatNoTickCanHaveAreRefusedByName) {
  const Model model = modelOf({boxBody({3, 3, 3}, 0.01)});
  Scene scene = sceneWith(Integrator::kLeapfrog, model, 0, 0.5);
  scene.solver.stability_monitor = true;
  scene.obstacles.emplace_back();
  scene.obstacles[0].position_m = Vector3d(0, 0, 0.2);
  const auto saving = makeCpu(simdTargets().front(), model, scene, 1),
             solver = makeCpu(simdTargets().front(), model, scene, 1);
  saving->writeState(randomState(model, 0.0005, 0.01, 3));
  for (int t = 0; t < 3; ++t) saving->step({});
  Archive saved;
  saving->persist(saved);
  Archive whole(saved.sections());
  solver->persist(whole);
  whole.end();
  EXPECT_EQ(stateHash(model, solver->readState()), stateHash(model, saving->readState()));
  for (const Spoilt& spoilt : spoiltTicks()) {
    std::vector<Archive::Section> sections = saved.sections();
    ASSERT_EQ(sections[0].name, "ticks");
    ASSERT_LE(spoilt.at + spoilt.bytes.size(), sections[0].bytes.size());
    std::copy(spoilt.bytes.begin(), spoilt.bytes.end(),
              sections[0].bytes.begin() + static_cast<std::ptrdiff_t>(spoilt.at));
    Archive read(sections);
    solver->reset();
    try {
      solver->persist(read);
      ADD_FAILURE() << "taken: " << spoilt.named << " at " << spoilt.at;
    } catch (const Error& error) {
      const std::string what = error.what();
      EXPECT_NE(what.find("section 'ticks'"), std::string::npos) << what;
      EXPECT_NE(what.find(spoilt.named), std::string::npos) << what;
      EXPECT_NE(what.find("accepted"), std::string::npos) << what;
    }
  }
  solver->reset();
  solver->step({});
  EXPECT_TRUE(isFinite(solver->readState()));
}
