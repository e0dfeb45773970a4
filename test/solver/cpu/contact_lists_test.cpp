// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>
#include <limits>

#include "solver/cpu/state/thread_pool.h"
#include "solver/cpu/steps/environment.h"
#include "solver/tissue/substeps.h"
#include "support/backends.h"
#include "support/features.h"
#include "support/loose_cloth.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kSpacing_m = 0.01;
constexpr int kSubsteps = 300;
constexpr float kDt_s = 1e-3f;

/// A crumpled sheet that drops onto another one and a block, with individual velocities of all nodes and without spring
/// forces: only contacts act.
struct Crowd {
  Crowd()
      : model(
            modelOf({looseCloth(16, 16, kSpacing_m), looseCloth(12, 12, kSpacing_m), boxBody({4, 4, 4}, kSpacing_m)})),
        scene(sceneFor(model, 1)),
        environment((scene.collision.enabled = true, model), scene) {
    environment.beginTick(kDt_s, 1, {});
  }
  HostState start() const {
    std::mt19937 random(17);
    HostState state = restState(model);
    for (size_t b = 0; b < model.bodies.size(); ++b) {
      for (const uint32_t local : model.bodies[b].lattice.active_slots) {
        const uint32_t slot = model.slotOffset(b) + local;
        const Vector3d fall(0, 0, b == 0 ? -0.4 : 0);
        state.displacement_m[slot] =
            vec4(Vector3d(0, 0, b == 0 ? 0.03 : -0.03 * double(b)) + randomVector(random, 0.004));
        state.velocity_m_per_s[slot] = vec4(fall + randomVector(random, 0.2));
      }
    }
    return state;
  }
  Model model;
  Scene scene;
  Environment environment;
};

/// The crowd with lists of a given margin.
class Trial {
 public:
  Trial(const Crowd& crowd, const Parallel& parallel, double margin, uint32_t most_in_bucket = kMostInBucket)
      : crowd_(crowd),
        lattice_(crowd.model, bodyParams(crowd.model, kDt_s), featuresFor(crowd.model, false)),
        contacts_(crowd.model, crowd.scene, lattice_, parallel, margin, most_in_bucket) {
    lattice_.write(crowd.start());
  }
  /// Acts as an integrator without forces, then applies contacts.
  void substep() {
    const AlignedVector<float>&u = lattice_.state.displacement[lattice_.state.current],
          &v = lattice_.state.velocity[lattice_.state.current];
    for (size_t i = 0; i < u.size(); ++i)
      lattice_.state.displacement[1 - lattice_.state.current][i] = u[i] + kDt_s * v[i];
    lattice_.state.velocity[1 - lattice_.state.current] = v;
    lattice_.swap();
    Substep step;
    step.dt_s = step.kick_s = kDt_s;
    step.push_speed_m_per_s = 0.1f;
    contacts_.run(lattice_, step, crowd_.environment);
  }
  /// Makes the changes that tissue undergoes in a scene.
  void disturb(int substep) {
    const uint32_t box = crowd_.model.slotOffset(2), cloth = crowd_.model.slotOffset(1);
    if (substep == 60) lattice_.store.nodes[box + inside()].lo |= layout::kSeveredBit;
    if (substep == 90) {
      lattice_.store.nodes[cloth + 7].lo &= ~layout::kAxialMask;  // isolated
      lattice_.store.nodes[cloth + 7].hi &= ~layout::kDiagonalMask;
    }
    if (substep == 120) move(9, 0.02f);
    if (substep == 150) move(11, std::numeric_limits<float>::quiet_NaN());
  }
  std::vector<CollisionPair> pairs() { return contacts_.findPairs(lattice_); }
  bool sameBitsAs(const Trial& other) const {
    return sameBits(lattice_.state.displacement[lattice_.state.current],
                    other.lattice_.state.displacement[other.lattice_.state.current]) &&
           sameBits(lattice_.state.velocity[lattice_.state.current],
                    other.lattice_.state.velocity[other.lattice_.state.current]);
  }
  size_t searches() const { return contacts_.searches(); }
  uint32_t crowded() const { return contacts_.crowded(); }

 private:
  uint32_t inside() const { return static_cast<uint32_t>(crowd_.model.bodies[2].lattice.slotAt({2, 2, 2})); }
  void move(uint32_t slot, float by_m) { lattice_.state.displacement[lattice_.state.current][vectorAt(slot)] += by_m; }
  static bool sameBits(const AlignedVector<float>& a, const AlignedVector<float>& b) {
    return std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
  }
  const Crowd& crowd_;
  CpuLattice lattice_;
  CpuEnvironment contacts_;
};

}  // namespace

TEST(ContactLists, ChangeNoBitAgainstASearchInEverySubstep) {
  const Crowd crowd;
  const Serial serial;
  const ThreadPool pool(3);
  Trial every(crowd, serial, 0), listed(crowd, serial, CpuEnvironment::kListMargin), wide(crowd, pool, 2);
  size_t most_pairs = 0;
  for (int s = 0; s < kSubsteps; ++s) {
    for (Trial* run : {&every, &listed, &wide}) {
      run->disturb(s);
      run->substep();
    }
    most_pairs = std::max(most_pairs, every.pairs().size());
    ASSERT_TRUE(listed.sameBitsAs(every)) << s;
    ASSERT_TRUE(wide.sameBitsAs(every)) << s;
  }
  EXPECT_GT(most_pairs, 50u);
}

/// If a bucket's limit is small, crowds form and dissolve all the time.
TEST(ContactLists, ChangeNoBitWhereNodesCrowdAndSpread) {
  constexpr uint32_t kMost = 3;
  const Crowd crowd;
  const Serial serial;
  const ThreadPool pool(3);
  Trial every(crowd, serial, 0, kMost), listed(crowd, serial, CpuEnvironment::kListMargin, kMost);
  Trial wide(crowd, pool, 2, kMost), whole(crowd, serial, 0);
  uint32_t fewest = std::numeric_limits<uint32_t>::max(), most = 0;
  for (int s = 0; s < kSubsteps; ++s) {
    for (Trial* run : {&every, &listed, &wide, &whole}) {
      run->disturb(s);
      run->substep();
    }
    ASSERT_TRUE(listed.sameBitsAs(every)) << s;
    ASSERT_TRUE(wide.sameBitsAs(every)) << s;
    ASSERT_EQ(listed.crowded(), every.crowded()) << s;
    ASSERT_EQ(wide.crowded(), every.crowded()) << s;
    fewest = std::min(fewest, every.crowded());
    most = std::max(most, every.crowded());
  }
  EXPECT_LT(fewest, most);
  EXPECT_FALSE(whole.sameBitsAs(every));
  EXPECT_EQ(whole.crowded(), 0u);
}

TEST(ContactLists, HoldTheSamePairsAsASearchInEverySubstep) {
  const Crowd crowd;
  const Serial serial;
  Trial every(crowd, serial, 0), listed(crowd, serial, CpuEnvironment::kListMargin);
  for (int s = 0; s < kSubsteps; ++s) {
    for (Trial* run : {&every, &listed}) {
      run->disturb(s);
      run->substep();
    }
    ASSERT_EQ(listed.pairs(), every.pairs()) << s;
  }
}

TEST(ContactLists, AreMadeAgainOnlyNowAndThen) {
  const Crowd crowd;
  const Serial serial;
  Trial every(crowd, serial, 0), listed(crowd, serial, CpuEnvironment::kListMargin);
  for (int s = 0; s < kSubsteps; ++s) {
    every.substep();
    listed.substep();
  }
  EXPECT_EQ(every.searches(), static_cast<size_t>(kSubsteps));
  EXPECT_LT(listed.searches(), static_cast<size_t>(kSubsteps) / 3);
  EXPECT_GT(listed.searches(), 5u);
}
