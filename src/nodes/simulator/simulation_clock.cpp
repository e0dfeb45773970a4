// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator/simulation_clock.h"

#include <utility>

namespace viscera::nodes {

SimulationClock::SimulationClock(ros::NodeHandle& node)
    : taken_(Clock::now()),
      ticks_(node.subscribe("tick", 1, &SimulationClock::onTick, this, ros::TransportHints().tcpNoDelay())) {}

void SimulationClock::onTick(const Tick& tick) {
  const std::lock_guard<std::mutex> lock(mutex_);
  simulated_.tell(tick.time_s, tick.tick_s, Clock::now());
  viewed_ = tick.viewed;
}

double SimulationClock::take() {
  const bool followed = ticks_.getNumPublishers() > 0;
  const std::lock_guard<std::mutex> lock(mutex_);
  const Clock::time_point now = Clock::now();
  const double simulated_s = simulated_.at(now);
  const double of_simulation_s = simulated_s - std::exchange(taken_simulated_s_, simulated_s);
  const double of_clock_s = std::chrono::duration<double>(now - std::exchange(taken_, now)).count();
  return followed ? of_simulation_s : of_clock_s;
}

bool SimulationClock::isViewed() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return viewed_;
}

}  // namespace viscera::nodes
