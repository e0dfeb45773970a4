// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/window_sizes.h"

#include <OgreRenderSystem.h>
#include <OgreRenderWindow.h>
#include <OgreRoot.h>

#include <set>
#include <string>

namespace viscera::rviz_plugin {

void renewWindowSizes() {
  static std::set<std::string> renewed;  // Ogre gives no name twice
  Ogre::RenderSystem::RenderTargetIterator targets =
      Ogre::Root::getSingleton().getRenderSystem()->getRenderTargetIterator();
  for (; targets.hasMoreElements(); targets.moveNext()) {
    auto* const window = dynamic_cast<Ogre::RenderWindow*>(targets.peekNextValue());
    if (window && renewed.insert(window->getName()).second) window->swapBuffers();
  }
}

}  // namespace viscera::rviz_plugin
