# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# cmake -DINCLUDE=folder -DEIGEN=folder -DWORK=folder -DCOMPILER=c++ -P this: a source that includes nothing but one header,
# for each of them.
file(GLOB_RECURSE headers RELATIVE ${INCLUDE} ${INCLUDE}/viscera/*.h)
list(LENGTH headers count)
if(count LESS 10)
  message(FATAL_ERROR "${count} headers under ${INCLUDE}: the library was not installed there")
endif()
file(REMOVE_RECURSE ${WORK})
set(sources "")
foreach(header ${headers})
  string(REPLACE "/" "_" name ${header})
  file(WRITE ${WORK}/${name}.cpp "#include <${header}>\n")
  list(APPEND sources ${WORK}/${name}.cpp)
endforeach()
math(EXPR half "${count} / 2")
list(SUBLIST sources 0 ${half} first)
list(SUBLIST sources ${half} -1 second)
set(compile ${COMPILER} -std=c++17 -fsyntax-only -Wall -Wextra -Werror -I${INCLUDE} -isystem ${EIGEN})
execute_process(COMMAND ${compile} ${first} COMMAND ${compile} ${second}  # both at once
                RESULTS_VARIABLE status ERROR_VARIABLE said)
message("${count} headers\n${said}")
if(NOT "${status}" STREQUAL "0;0")
  message(FATAL_ERROR "a header needs what is not installed, or does not include what it uses")
endif()
