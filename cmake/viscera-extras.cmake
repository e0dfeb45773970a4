# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# Included by find_package(viscera) in a catkin workspace: the target viscera::core, as outside of one.
if(NOT TARGET viscera::core)
  find_package(Eigen3 REQUIRED)
  set(viscera_core_library ${viscera_LIBRARIES})
  list(FILTER viscera_core_library INCLUDE REGEX "viscera_core")
  add_library(viscera::core INTERFACE IMPORTED)
  set_target_properties(viscera::core PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${viscera_INCLUDE_DIRS}"
                                                 INTERFACE_LINK_LIBRARIES "${viscera_core_library};Eigen3::Eigen"
                                                 INTERFACE_COMPILE_FEATURES cxx_std_17)
  unset(viscera_core_library)
endif()
