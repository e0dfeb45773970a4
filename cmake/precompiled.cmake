# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# What nearly every source includes, parsed once: Eigen and the standard library for all, GoogleTest with them for tests.
# -DVISCERA_PCH=OFF builds without, as a check that every source includes what it uses.
option(VISCERA_PCH "Precompile the headers that most sources include" ON)
set(VISCERA_STANDARD_HEADERS <Eigen/Core> <Eigen/Geometry> <algorithm> <array> <chrono> <cmath> <functional> <map> <memory>
    <optional> <set> <sstream> <string> <vector>)

# Precompiles the headers for the targets that take `kind`. A program, as flags must be those of the targets: GCC tells -fPIE from -fPIC.
function(viscera_precompiled kind type)
  if(NOT VISCERA_PCH)
    return()
  endif()
  set(source ${PROJECT_BINARY_DIR}/precompiled_${kind}.cpp)
  if(NOT EXISTS ${source})
    file(WRITE ${source} "// Made by cmake/precompiled.cmake.\nint main() {}\n")
  endif()
  if(type STREQUAL LIBRARY)
    add_library(viscera_precompiled_${kind} STATIC ${source})
  else()
    add_executable(viscera_precompiled_${kind} ${source})
  endif()
  target_compile_options(viscera_precompiled_${kind} PRIVATE ${VISCERA_CXX_FLAGS})
  target_link_libraries(viscera_precompiled_${kind} PRIVATE Eigen3::Eigen)
  target_precompile_headers(viscera_precompiled_${kind} PRIVATE ${ARGN})
endfunction()

function(viscera_use_precompiled target kind)
  if(VISCERA_PCH)
    target_precompile_headers(${target} REUSE_FROM viscera_precompiled_${kind})
  endif()
endfunction()

viscera_precompiled(core LIBRARY ${VISCERA_STANDARD_HEADERS})
