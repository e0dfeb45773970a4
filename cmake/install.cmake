# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# With ROS the places are catkin's, so that roslaunch finds everything in an install space.
if(NOT TARGET viscera_nodes)
  set(VISCERA_BIN ${CMAKE_INSTALL_BINDIR})
  set(VISCERA_SHARE ${CMAKE_INSTALL_DATADIR}/viscera)
  install(FILES package.xml DESTINATION ${VISCERA_SHARE})
else()
  set(VISCERA_BIN ${CATKIN_GLOBAL_BIN_DESTINATION})
  set(VISCERA_SHARE ${CATKIN_PACKAGE_SHARE_DESTINATION})
  install(TARGETS ${VISCERA_NODES} RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
endif()
#catkin_lint: ignore undefined_target
if(TARGET viscera)
  install(TARGETS viscera RUNTIME DESTINATION ${VISCERA_BIN})
endif()
if(TARGET viscera-dicom)
  install(TARGETS viscera-dicom RUNTIME DESTINATION ${VISCERA_BIN})
endif()
if(TARGET viscera-bench)
  install(TARGETS viscera-bench RUNTIME DESTINATION ${VISCERA_BIN})
endif()
install(DIRECTORY config launch DESTINATION ${VISCERA_SHARE})
if(VISCERA_WITH_ROS)  # catkin's setup files that name their own folder: that of the prefix, whichever it is
  #catkin_lint: ignore_once env_var
  install(CODE "
    foreach(name setup.sh local_setup.sh .rosinstall)
      set(file \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/\${name}\")
      if(EXISTS \"\${file}\")
        file(READ \"\${file}\" text)
        string(REPLACE \"_CATKIN_SETUP_DIR:=.}\" \"_CATKIN_SETUP_DIR:=\${CMAKE_INSTALL_PREFIX}}\" text \"\${text}\")
        string(REPLACE \"local-name: ./\" \"local-name: \${CMAKE_INSTALL_PREFIX}/\" text \"\${text}\")
        file(WRITE \"\${file}\" \"\${text}\")
      endif()
    endforeach()")
endif()
if(VISCERA_KERNEL_TARGETS STREQUAL native)
  install(CODE "message(WARNING \"The CPU kernels are those of this machine's processor alone: configure with -DVISCERA_KERNEL_TARGETS=all for others\")")
endif()
