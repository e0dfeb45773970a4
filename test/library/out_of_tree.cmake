# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# cmake -DEXAMPLE=folder -DWORK=folder -DPREFIX=folder -DCOMPILER=c++ -DSCENE=file -P this: configures, builds and runs the
# example, and looks at the skin that it writes.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE said ERROR_VARIABLE said WORKING_DIRECTORY ${WORK})
  message("${said}")
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "status ${status}: ${ARGN}")
  endif()
endfunction()
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
run(${CMAKE_COMMAND} -S ${EXAMPLE} -B ${WORK}/build -DCMAKE_PREFIX_PATH=${PREFIX} -DCMAKE_CXX_COMPILER=${COMPILER}
    -DCMAKE_CXX_FLAGS=-Wall\ -Wextra\ -Werror)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/hello_session ${SCENE} ${WORK}/skin.ply)
file(READ ${WORK}/skin.ply head LIMIT 400)
if(NOT head MATCHES "^ply\n" OR NOT head MATCHES "element vertex [1-9][0-9]*" OR NOT head MATCHES "element face [1-9][0-9]*")
  message(FATAL_ERROR "skin.ply is no mesh: ${head}")
endif()
