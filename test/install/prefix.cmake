# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# `cmake --install BUILD --prefix PREFIX`: all files are below the prefix, and its setup file makes ROS find them there, and
# a user can work with it.
# cmake -DBUILD=... -P prefix.cmake
# The prefix is not below the package: roslaunch would find its launch files twice.
set(temporary $ENV{TMPDIR})
if(NOT temporary)
  set(temporary /tmp)
endif()
string(MD5 of_build "${BUILD}")
set(PREFIX ${temporary}/viscera_prefix_${of_build})
file(REMOVE_RECURSE ${PREFIX})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${PREFIX} OUTPUT_VARIABLE said RESULT_VARIABLE status)
if(status)
  message(FATAL_ERROR "cmake --install fails: ${said}")
endif()
string(REGEX MATCHALL "(Installing|Up-to-date): [^\n]*" files "${said}")
foreach(file ${files})
  string(REGEX REPLACE "^[^:]*: " "" file "${file}")
  string(FIND "${file}" "${PREFIX}/" at)
  if(NOT at EQUAL 0)
    message(SEND_ERROR "installed outside of the prefix: ${file}")
  endif()
endforeach()
foreach(shell bash sh)
  # from another folder, with nothing of the build in the environment
  execute_process(COMMAND ${CMAKE_COMMAND} -E env --unset=CMAKE_PREFIX_PATH --unset=ROS_PACKAGE_PATH --unset=PYTHONPATH
                          ${shell} -c "cd / && . ${PREFIX}/setup.${shell} && rospack find viscera" OUTPUT_VARIABLE found ERROR_VARIABLE found)
  string(STRIP "${found}" found)
  if(NOT found STREQUAL "${PREFIX}/share/viscera")
    message(SEND_ERROR "setup.${shell}: rospack finds viscera in '${found}'")
  endif()
  if(NOT EXISTS ${PREFIX}/share/viscera/launch/training.launch OR NOT EXISTS ${PREFIX}/lib/viscera/simulator)
    message(SEND_ERROR "no launch files or nodes in ${PREFIX}")
  endif()
endforeach()
execute_process(COMMAND bash ${CMAKE_CURRENT_LIST_DIR}/as_a_user ${PREFIX} ${PREFIX}_user RESULT_VARIABLE status)
if(status)
  message(SEND_ERROR "test/install/as_a_user fails with ${PREFIX}")
endif()
file(REMOVE_RECURSE ${PREFIX} ${PREFIX}_user)
