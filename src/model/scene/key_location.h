// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

/// Error: a key of a body does not suit its tissue. Code that knows the scene's file prefixes file and line
/// (withLocation).
struct BodyKeyError : SceneError {
  /// @param its_key  path within the body, as in fixed[0]   @param its_reason  text after the key
  BodyKeyError(const std::string& body, const std::string& its_key, const std::string& its_reason)
      : SceneError("body '" + body + "': " + its_key + its_reason), key(its_key), reason(its_reason) {}
  std::string key, reason;
};

/// Error that names file, line and key.
struct PlacedError : SceneError {
  using SceneError::SceneError;
};

/// Returns "FILE:LINE: PATH" of a key in a scene's file, "FILE: PATH" where it was an override.
/// @param path  as in bodies[0].fixed[1]
std::string locationOf(const std::string& file, const std::string& path);

/// Runs `act` for a body of the scene. @throws PlacedError, MeshError  with the body's place in the file
template <class Act>
auto withLocation(const Scene& scene, size_t body, const Act& act) {
  const std::string path = "bodies[" + std::to_string(body) + "]";
  try {
    return act();
  } catch (const BodyKeyError& error) {
    if (scene.file.empty()) throw;
    throw PlacedError(locationOf(scene.file, path + "." + error.key) + error.reason);
  } catch (const MeshError& error) {
    if (scene.file.empty()) throw;
    throw MeshError(locationOf(scene.file, path) + ": " + error.what());
  }
}

}  // namespace viscera
