# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# find_package(viscera): the target viscera::core, and the same as catkin's two variables.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3)
include(${CMAKE_CURRENT_LIST_DIR}/viscera-targets.cmake)
get_target_property(viscera_INCLUDE_DIRS viscera::core INTERFACE_INCLUDE_DIRECTORIES)
set(viscera_LIBRARIES viscera::core)
# For find_package(catkin COMPONENTS viscera), where catkin's configuration is installed in this folder (debian/rules): messages too.
if(COMMAND catkin_package)
  include(${CMAKE_CURRENT_LIST_DIR}/viscera-catkin.cmake OPTIONAL)
endif()
