# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# cmake -DINCLUDE=folder -DEIGEN=folder -DWORK=folder -DCOMPILER=c++ -P this: a source that includes nothing but one header,
# for each of them; all headers of one folder are compiled in one call of the compiler.
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
execute_process(COMMAND ${COMPILER} -std=c++17 -fsyntax-only -Wall -Wextra -Werror -I${INCLUDE} -isystem ${EIGEN} ${sources}
                RESULT_VARIABLE status ERROR_VARIABLE said)
message("${count} headers\n${said}")
if(NOT status EQUAL 0)
  message(FATAL_ERROR "a header needs what is not installed, or does not include what it uses")
endif()
