# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# The Python package viscera, where pybind11, NumPy and Python's headers are. Found by their files: pybind11's own search takes
# whatever interpreter is first in PATH, which may have no NumPy, and ROS's modules are those of the distribution's interpreter.
option(VISCERA_PYTHON "Build the Python package where pybind11 and NumPy are found" ON)
if(NOT VISCERA_PYTHON)
  return()
endif()
find_program(VISCERA_PYTHON_EXECUTABLE python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_path(PYBIND11_INCLUDE_DIR pybind11/pybind11.h)
set(about "")
if(VISCERA_PYTHON_EXECUTABLE)
  execute_process(COMMAND ${VISCERA_PYTHON_EXECUTABLE} -c
                  "import numpy, sysconfig as s; print(s.get_path('include'), s.get_config_var('EXT_SUFFIX'), sep=';', end='')"
                  OUTPUT_VARIABLE about ERROR_QUIET)
endif()
if(about AND PYBIND11_INCLUDE_DIR)
  list(GET about 0 python_include)
  list(GET about 1 python_suffix)
endif()
if(NOT EXISTS "${python_include}/Python.h")
  message(STATUS "pybind11, NumPy or Python.h not found (Debian: pybind11-dev python3-numpy python3-dev): no Python package")
  return()
endif()

# The folder of the messages' modules where there is ROS: genpy leaves an __init__.py that is there, and writes an empty one
# in a fresh build before ours takes its place. catkin installs that whole folder, so nothing lies in it that is not shipped.
set(python_prefix ${PROJECT_BINARY_DIR}/devel)
set(python_folder lib/python3/dist-packages/viscera)
if(VISCERA_WITH_ROS)
  set(python_prefix ${CATKIN_DEVEL_PREFIX})
  set(python_folder ${PYTHON_INSTALL_DIR}/viscera)
endif()
set(python_built ${python_prefix}/${python_folder})
file(GLOB python_sources CONFIGURE_DEPENDS src/python/*.cpp)
add_library(viscera_python MODULE ${python_sources})
target_include_directories(viscera_python PRIVATE src)
target_include_directories(viscera_python SYSTEM PRIVATE ${python_include} ${PYBIND11_INCLUDE_DIR})
target_compile_options(viscera_python PRIVATE ${VISCERA_CXX_FLAGS})
target_compile_definitions(viscera_python PRIVATE VISCERA_VERSION="${PROJECT_VERSION}")
target_link_libraries(viscera_python PRIVATE viscera_export)
set(map ${PROJECT_SOURCE_DIR}/cmake/python.map)
target_link_options(viscera_python PRIVATE -Wl,--version-script=${map})
set_target_properties(viscera_python PROPERTIES PREFIX "" OUTPUT_NAME _viscera SUFFIX ${python_suffix} ${VISCERA_HIDDEN}
                                                LIBRARY_OUTPUT_DIRECTORY ${python_built} LINK_DEPENDS ${map})
file(GLOB_RECURSE python_texts CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/src/python/viscera src/python/viscera/*.py
     src/python/viscera/*.pyi src/python/viscera/py.typed)
foreach(file ${python_texts})
  configure_file(src/python/viscera/${file} ${python_built}/${file} COPYONLY)
endforeach()
file(WRITE ${python_prefix}/share/viscera/config_folder.txt "${PROJECT_SOURCE_DIR}/config\n")  # of shipped scenes
install(TARGETS viscera_python LIBRARY DESTINATION ${python_folder} COMPONENT python)
install(DIRECTORY src/python/viscera/ DESTINATION ${python_folder} COMPONENT python FILES_MATCHING REGEX "\\.(pyi?|typed)$"
        PATTERN __pycache__ EXCLUDE)
