# Compiler flags of every target, the compiler cache and the sanitizers.

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")

find_program(VARIFOLD_CCACHE ccache)
if(VARIFOLD_CCACHE)
  set(CMAKE_C_COMPILER_LAUNCHER ${VARIFOLD_CCACHE})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${VARIFOLD_CCACHE})
endif()

add_library(varifold_flags INTERFACE)
# No contraction: the same bytes from every compiler and every build type.
target_compile_options(varifold_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow
                       -Wno-missing-field-initializers  # designated initialisers leave defaults
                       -ffp-contract=off -fno-math-errno
                       # Position-independent, but nobody replaces our functions: let them inline.
                       -fno-semantic-interposition)
target_include_directories(varifold_flags INTERFACE ${CMAKE_SOURCE_DIR}/src)

if(VARIFOLD_SANITIZE)
  add_compile_options(-fsanitize=${VARIFOLD_SANITIZE} -fno-omit-frame-pointer
                      -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${VARIFOLD_SANITIZE})
endif()
