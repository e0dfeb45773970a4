// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/haptics/simulated_device.h"

#include <gtest/gtest.h>

#include <cmath>

namespace viscera {
namespace {

TEST(SimulatedDevice, ComesToRestWhereUserAndForceBalance) {
  SimulatedDeviceConfig config;
  SimulatedDevice device(config, Vector3d::Zero());
  for (int i = 0; i < 3000; ++i) device.step({0, 0, 0.6}, Vector3d::Zero());
  EXPECT_NEAR(device.position_m().z(), 0.6 / config.hand_stiffness_n_per_m, 1e-7);
  EXPECT_NEAR(device.measured_m().z(), device.position_m().z(), 0.5 * config.encoder_m + 1e-12);
}

TEST(SimulatedDevice, SwingsWithTheFrequencyOfItsMassInTheGrip) {
  SimulatedDeviceConfig config;
  config.mass_kg = 0.5;
  config.damping_n_s_per_m = config.hand_damping_n_s_per_m = 0;
  SimulatedDevice device(config, Vector3d::Zero());
  int crossings = 0;
  double last = 0;
  const int periods = 5000;
  for (int i = 0; i < periods; ++i) {
    device.step(Vector3d::Zero(), {0, 0, 0.01});
    const double off = device.position_m().z() - 0.01;
    crossings += (off > 0) != (last > 0);
    last = off;
  }
  const double hz = std::sqrt(config.hand_stiffness_n_per_m / config.mass_kg) / 6.283185307179586;
  EXPECT_NEAR(crossings / 2.0, hz * periods * config.period_s, 1);
}

TEST(SimulatedDevice, AnswersADelayLater) {
  SimulatedDeviceConfig config;
  config.hand_stiffness_n_per_m = config.hand_damping_n_s_per_m = 0;
  config.delay_s = 0.01;
  config.encoder_m = 0;
  SimulatedDevice device(config, Vector3d::Zero());
  // A force that answers the pose of a period acts in the tenth period after it.
  int measured = -1, acted = -1;
  for (int i = 0; i < 40; ++i) {
    if (measured < 0 && device.measured_m().z() > 0) measured = i;
    device.step({0, 0, i >= 3 ? 1.0 : 0.0}, Vector3d::Zero());
    if (acted < 0 && device.acting_n().z() > 0) acted = i;
  }
  EXPECT_EQ(acted, 3 + 5);
  EXPECT_EQ(measured, acted + 1 + 5);
}

TEST(SimulatedDevice, CountsTheWorkOfItsMotors) {
  SimulatedDeviceConfig config;
  SimulatedDevice device(config, Vector3d::Zero());
  for (int i = 0; i < 3000; ++i) device.step({0, 0, -0.6}, Vector3d::Zero());
  EXPECT_NEAR(device.energy_j(), -0.6 * 0.6 / config.hand_stiffness_n_per_m, 1e-6);
}

}  // namespace
}  // namespace viscera
