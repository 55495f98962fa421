# One target a folder: homing_library(NAME SOURCES ... DEPS ...), homing_test(NAME SOURCES ... DEPS ...).
# All presets compile a folder's sources eight at a time (unity build), since most of the time goes into what
# they include. Names in unnamed namespaces are therefore a folder's.
include(CMakeParseArguments)

# g++ 12 takes an empty std::optional for an uninitialised one when it inlines much (-O3): not an error.
set(HOMING_WARNINGS -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wnon-virtual-dtor -Werror
  -Wno-maybe-uninitialized)
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  list(APPEND HOMING_WARNINGS -Wno-unknown-warning-option)
endif()

function(homing_library name)
  cmake_parse_arguments(A "" "" "SOURCES;DEPS" ${ARGN})
  add_library(${name} STATIC ${A_SOURCES})
  target_compile_options(${name} PRIVATE ${HOMING_WARNINGS})
  target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PUBLIC ${A_DEPS})
endfunction()

# Under sanitizers, what waits more than it computes is not optimised: it compiles in half of the time. For the targets
# of this folder, and of those below, that come after it.
macro(homing_compile_fast_under_sanitizers)
  if(HOMING_SANITIZE)
    add_compile_options(-O0)
  endif()
endmacro()

# What programs allocate with: see docs/decisions/0030. Sanitizers bring their own.
add_library(homing_allocator INTERFACE)
if(NOT HOMING_SANITIZE)
  find_library(JEMALLOC_LIBRARY jemalloc REQUIRED)
  target_link_libraries(homing_allocator INTERFACE ${JEMALLOC_LIBRARY})
endif()

# A GoogleTest program, one ctest entry a case; with sanitizers one entry in all (or SHARDS), since a program with
# them takes a second to start. Compiled without optimisation, which halves the time: it is not what is measured.
function(homing_test name)
  cmake_parse_arguments(A "" "TIMEOUT;SHARDS" "SOURCES;DEPS" ${ARGN})
  if(NOT A_TIMEOUT)
    set(A_TIMEOUT 300)
  endif()
  add_executable(${name} ${A_SOURCES})
  target_compile_options(${name} PRIVATE ${HOMING_WARNINGS} -O0)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE ${A_DEPS} GTest::gmock GTest::gtest_main)
  if(HOMING_SANITIZE)
    if(NOT A_SHARDS)
      set(A_SHARDS 1)
    endif()
    math(EXPR last "${A_SHARDS} - 1")
    foreach(shard RANGE ${last})
      # The sharded ones first: they are the long ones.
      add_test(NAME ${name}_${shard} COMMAND ${name})
      set_tests_properties(${name}_${shard} PROPERTIES TIMEOUT 1500 COST ${A_SHARDS}
        ENVIRONMENT "GTEST_TOTAL_SHARDS=${A_SHARDS};GTEST_SHARD_INDEX=${shard}")
    endforeach()
  else()
    gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT ${A_TIMEOUT})
  endif()
endfunction()
