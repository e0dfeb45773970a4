# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# -DVISCERA_SANITIZE=address,undefined or thread: everything is compiled so that it watches itself while it runs
# (CONTRIBUTING.md has the commands). Meant for a build folder of its own.
set(VISCERA_SANITIZE "" CACHE STRING "Sanitizers to build with, as GCC and Clang name them: address,undefined or thread")
if(VISCERA_SANITIZE)
  # What undefined behaviour there is ends the program, so that no test passes over it. Asserts stay in.
  set(sanitize_flags -fsanitize=${VISCERA_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  if(VISCERA_SANITIZE MATCHES "undefined")
    # With them GCC no longer knows at compile time that a function has an address, which a static_assert asks; a null
    # pointer that is used ends the program without them too.
    list(APPEND sanitize_flags -fno-sanitize=null,nonnull-attribute,returns-nonnull-attribute)
  endif()
  add_compile_options(${sanitize_flags})
  add_link_options(${sanitize_flags})
  add_compile_definitions(_GLIBCXX_ASSERTIONS)
  set(CMAKE_CXX_FLAGS_RELEASE "-O1 -g1")
  set(VISCERA_KERNELS -O1)  # at -O3 GCC needs minutes for each of them
  # GCC's warnings of uninitialised values are wrong about code with the checks in it.
  set(VISCERA_WERROR OFF)
endif()
