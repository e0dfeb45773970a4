# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# What rviz loads: a display, a panel and a tool (src/rviz), named in config/rviz_plugins.xml, which package.xml exports.
# Of the project it has the messages, what viewers receive (src/nodes/received), the names of tools, how a tip follows a mouse, and how numbers are read. Without rviz's headers the markers remain.
find_package(rviz QUIET)
find_package(Qt5 QUIET COMPONENTS Widgets)
if(NOT rviz_FOUND OR NOT Qt5_FOUND)
  message(STATUS "rviz's headers not found (Debian: librviz-dev): the rviz plugin is left out")
  return()
endif()
file(GLOB rviz_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/rviz/*.cpp ${PROJECT_SOURCE_DIR}/src/nodes/received/*.cpp)
# Sources of nodes, devices and math themselves, not their libraries: rviz loads this one beside others.
add_library(viscera_rviz SHARED ${rviz_sources} ${PROJECT_SOURCE_DIR}/src/devices/steered_tool.cpp
                                ${PROJECT_SOURCE_DIR}/src/math/number_text.cpp)
viscera_unity(viscera_rviz 24)
add_dependencies(viscera_rviz ${PROJECT_NAME}_generate_messages_cpp ${catkin_EXPORTED_TARGETS})
target_include_directories(viscera_rviz PUBLIC ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/include)
target_include_directories(viscera_rviz SYSTEM PUBLIC ${CATKIN_DEVEL_PREFIX}/${CATKIN_GLOBAL_INCLUDE_DESTINATION}
                           ${catkin_INCLUDE_DIRS} PRIVATE ${rviz_INCLUDE_DIRS})
# Qt's words `signals` and `slots` are names of boost's.
target_compile_definitions(viscera_rviz PRIVATE ${VISCERA_ROS_DEFINITIONS} QT_NO_KEYWORDS)
target_compile_options(viscera_rviz PRIVATE ${VISCERA_CXX_FLAGS})
target_link_libraries(viscera_rviz PUBLIC ${catkin_LIBRARIES} Eigen3::Eigen PRIVATE ${rviz_LIBRARIES} Qt5::Widgets)
# Where pluginlib looks for it.
set_target_properties(viscera_rviz PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/lib)
install(TARGETS viscera_rviz LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
