# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# With ROS the places are catkin's, so that roslaunch finds everything in an install space.
if(TARGET viscera_nodes)
  set(VISCERA_BIN ${CATKIN_GLOBAL_BIN_DESTINATION})
  set(VISCERA_SHARE ${CATKIN_PACKAGE_SHARE_DESTINATION})
  install(TARGETS ${VISCERA_NODES} RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
else()
  set(VISCERA_BIN ${CMAKE_INSTALL_BINDIR})
  set(VISCERA_SHARE ${CMAKE_INSTALL_DATADIR}/viscera)
  install(FILES package.xml DESTINATION ${VISCERA_SHARE})
endif()
if(TARGET viscera)
  install(TARGETS viscera RUNTIME DESTINATION ${VISCERA_BIN})
endif()
if(TARGET viscera-bench)
  install(TARGETS viscera-bench RUNTIME DESTINATION ${VISCERA_BIN})
endif()
install(DIRECTORY config launch DESTINATION ${VISCERA_SHARE})
