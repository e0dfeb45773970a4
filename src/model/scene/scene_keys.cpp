// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scene/key_table.h"
#include "model/scene/whole_scene_fields.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

std::string sceneKeysTable() {
  return keyTable<Scene>();
}

}  // namespace viscera
