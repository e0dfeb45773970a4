// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Loads a scene, moves its first stylus into the tissue, and writes the deformed skin. Needs no GPU, display or ROS.
#include <exception>
#include <iostream>

#include "viscera/session/session.h"
#include "viscera/surface/shown_mesh.h"

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::cerr << "usage: hello_session SCENE.yaml SKIN.ply\n";
    return 2;
  }
  constexpr int kTicks = 60;
  constexpr double kWay_m = 0.04;
  viscera::Session session(viscera::loadScene(argv[1]));
  viscera::StylusSamples hands;
  hands[0].valid = true;
  viscera::Wants wants;
  viscera::Frame frame;
  for (int tick = 1; tick <= kTicks; ++tick) {
    hands[0].pose.position_m = {0, -0.07 + kWay_m * tick / kTicks, -0.015};  // tissue frame, from the front
    wants.surface = tick == kTicks;
    frame = session.step(hands, wants);
  }
  const viscera::Vector3d force_n = frame.reactions[0].force_n;
  if (!frame.surface) frame = session.drain();
  viscera::writePly(*frame.surface, argv[2]);
  std::cout << session.backendNote() << "\nforce on the stylus: " << force_n.transpose() << " N\n"
            << argv[2] << ": " << frame.surface->vertices() << " vertices\n";
} catch (const std::exception& e) {
  std::cerr << "hello_session: " << e.what() << '\n';
  return 1;
}
