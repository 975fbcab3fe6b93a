# varifold_library(NAME SOURCES file... [DEPENDS target...] [PRIVATE target...])
# One static library per folder: varifold_NAME, alias varifold::NAME.
function(varifold_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;PRIVATE" ${ARGN})
  add_library(varifold_${name} STATIC ${ARG_SOURCES})
  add_library(varifold::${name} ALIAS varifold_${name})
  target_link_libraries(varifold_${name} PUBLIC varifold_flags ${ARG_DEPENDS}
                        PRIVATE ${ARG_PRIVATE})
  set_target_properties(varifold_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
endfunction()

# varifold_test(NAME SOURCES file... [LINK target...]): one GoogleTest program per folder of src.
function(varifold_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(varifold_${name}_test ${ARG_SOURCES})
  target_link_libraries(varifold_${name}_test PRIVATE varifold_flags varifold_test_support
                        GTest::gtest_main ${ARG_LINK})
  gtest_discover_tests(varifold_${name}_test DISCOVERY_MODE PRE_TEST
                       WORKING_DIRECTORY ${CMAKE_SOURCE_DIR}
                       PROPERTIES TIMEOUT 600)
endfunction()
