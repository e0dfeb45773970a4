# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# For which instruction sets Highway compiles the CPU kernels:
#   all     SSE4, AVX2 and AVX-512, chosen at run time: for what is installed, bundled or tested
#   native  the best one of this machine alone: a third of the time to compile them
set(VISCERA_KERNEL_TARGETS all CACHE STRING "Instruction sets of the CPU kernels: all or native")
set_property(CACHE VISCERA_KERNEL_TARGETS PROPERTY STRINGS all native)
if(NOT VISCERA_KERNEL_TARGETS MATCHES "^(all|native)$")
  message(FATAL_ERROR "VISCERA_KERNEL_TARGETS is '${VISCERA_KERNEL_TARGETS}': all or native is accepted")
endif()
set(VISCERA_KERNEL_FLAGS "")
set(VISCERA_KERNEL_DEFINITIONS "")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|i[3-6]86")
  # SSE4 is the least that is supported; without it Highway would take SSE2, which lacks 128-bit shuffles.
  set(VISCERA_KERNEL_FLAGS -msse4.2 -maes -mpclmul)
  if(VISCERA_KERNEL_TARGETS STREQUAL native)
    execute_process(COMMAND ${CMAKE_CXX_COMPILER} -march=native -dM -E -x c++ /dev/null OUTPUT_VARIABLE macros ERROR_QUIET)
    set(best HWY_SSE4)
    if(macros MATCHES "__AVX512F__" AND macros MATCHES "__AVX512BW__" AND macros MATCHES "__AVX512VL__"
       AND macros MATCHES "__AVX512DQ__" AND macros MATCHES "__AVX512CD__")
      set(best HWY_AVX3)
    elseif(macros MATCHES "__AVX2__" AND macros MATCHES "__FMA__" AND macros MATCHES "__BMI2__")
      set(best HWY_AVX2)
    endif()
    set(VISCERA_KERNEL_DEFINITIONS HWY_COMPILE_ONLY_STATIC HWY_BASELINE_TARGETS=${best})
    message(STATUS "CPU kernels: ${best} alone")
  endif()
endif()
