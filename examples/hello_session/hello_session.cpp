// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Loads a scene, moves its first stylus into the tissue, and writes the deformed surface mesh. Needs no GPU, display or
// ROS.
#include <exception>
#include <iostream>

#include "viscera/session/session.h"
#include "viscera/surface/visible_mesh.h"

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::cerr << "usage: hello_session SCENE.yaml SKIN.ply\n";
    return 2;
  }
  constexpr int kTicks = 60;
  constexpr double kTravel_m = 0.04;
  viscera::Session session(viscera::loadScene(argv[1]));
  viscera::StylusSamples samples;
  samples[0].valid = true;
  viscera::FrameRequest request;
  viscera::Frame frame;
  for (int tick = 1; tick <= kTicks; ++tick) {
    samples[0].pose.position_m = {0, -0.07 + kTravel_m * tick / kTicks, -0.015};  // tissue frame, from the front
    request.surface = tick == kTicks;
    frame = session.step(samples, request);
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
