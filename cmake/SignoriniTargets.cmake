# How every target of ours is made: C++20, warnings as errors, one include root.

option(SIGNORINI_WERROR "Treat warnings on our own targets as errors" ${PROJECT_IS_TOP_LEVEL})

option(SIGNORINI_PRECOMPILE "Precompile the headers of Eigen, GoogleTest and C++: a full build takes less time" OFF)
set(SIGNORINI_COMMON_HEADERS <Eigen/Core> <Eigen/SparseCore> <algorithm> <cmath> <functional> <memory>
    <optional> <stdexcept> <string> <vector>)

# What every source includes is parsed once a library (whose files share their compile options).
function(signorini_precompile target)
  if(SIGNORINI_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE ${SIGNORINI_COMMON_HEADERS})
  endif()
endfunction()

# What every test includes is parsed once for all tests. They agree on EIGEN_DONT_PARALLELIZE, which
# signorini::lcp asks for, whatever they link.
function(signorini_precompile_test target)
  target_compile_definitions(${target} PRIVATE EIGEN_DONT_PARALLELIZE)
  if(NOT SIGNORINI_PRECOMPILE)
    return()
  endif()
  if(NOT TARGET signorini_test_headers)
    file(WRITE ${PROJECT_BINARY_DIR}/test_headers.cpp "// Its headers are what is precompiled.\n")
    add_library(signorini_test_headers OBJECT ${PROJECT_BINARY_DIR}/test_headers.cpp)
    signorini_test_options(signorini_test_headers)
    target_compile_definitions(signorini_test_headers PRIVATE EIGEN_DONT_PARALLELIZE)
    target_link_libraries(signorini_test_headers PRIVATE Eigen3::Eigen GTest::gtest_main)
    target_precompile_headers(signorini_test_headers PRIVATE <gtest/gtest.h> ${SIGNORINI_COMMON_HEADERS}
      <limits> <random> <sstream> <fstream> <filesystem>)
  endif()
  target_precompile_headers(${target} REUSE_FROM signorini_test_headers)
endfunction()

function(signorini_compile_options target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
    -Woverloaded-virtual -Wimplicit-fallthrough
    $<$<CXX_COMPILER_ID:GNU>:-Wdouble-promotion>)  # clang's also warns of long double, which is meant
  if(SIGNORINI_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(SIGNORINI_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # g++ 12 is wrong about moved strings, and no longer sees a system header
    target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-restrict -Wno-stringop-overread)
    # Collecting garbage took it a tenth of its time; with this much room it hardly does (1 GB a job).
    target_compile_options(${target} PRIVATE --param=ggc-min-expand=200 --param=ggc-min-heapsize=1000000)
  endif()
endfunction()

# The tests' own code is compiled faster and runs slower; what they test is compiled as ever. (Under
# the sanitizers, of type RelWithDebInfo, a test takes half as long to compile with -O0 as with -O1.)
function(signorini_test_options target)
  signorini_compile_options(${target})
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1> $<$<CONFIG:RelWithDebInfo>:-O0>)
endfunction()

# signorini_library(NAME SOURCES ... DEPENDS ... [EXPORTS MAP]): target signorini_NAME, alias
# signorini::NAME. A shared library exports what its linker script says, by default namespace signorini.
function(signorini_library name)
  cmake_parse_arguments(ARG "" "EXPORTS" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  set(target signorini_${name})
  add_library(${target} ${ARG_SOURCES})
  add_library(signorini::${name} ALIAS ${target})
  signorini_compile_options(${target})
  signorini_precompile(${target})
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${SIGNORINI_INCLUDE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${target} PUBLIC ${ARG_DEPENDS} PRIVATE ${ARG_PRIVATE_DEPENDS})
  set_target_properties(${target} PROPERTIES
    EXPORT_NAME ${name} OUTPUT_NAME signorini-${name}
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR} POSITION_INDEPENDENT_CODE ON
    INSTALL_RPATH $ORIGIN DEFINE_SYMBOL "")
  if(BUILD_SHARED_LIBS AND UNIX AND NOT APPLE)
    set(map ${PROJECT_SOURCE_DIR}/cmake/signorini.map)
    if(ARG_EXPORTS)
      set(map ${ARG_EXPORTS})
    endif()
    target_link_options(${target} PRIVATE -Wl,--version-script=${map})
    set_target_properties(${target} PROPERTIES LINK_DEPENDS ${map})
  endif()
  set_property(GLOBAL APPEND PROPERTY SIGNORINI_LIBRARIES ${target})
endfunction()

# signorini_program(NAME SOURCES ... DEPENDS ...): an installed executable.
function(signorini_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  signorini_compile_options(${name})
  target_link_libraries(${name} PRIVATE ${ARG_DEPENDS})
  target_include_directories(${name} PRIVATE ${SIGNORINI_INCLUDE_DIR})
  set_target_properties(${name} PROPERTIES INSTALL_RPATH $ORIGIN/../${CMAKE_INSTALL_LIBDIR})
  set_property(GLOBAL APPEND PROPERTY SIGNORINI_PROGRAMS ${name})
endfunction()

# signorini_test(NAME SOURCES ... DEPENDS ... [TIMEOUT seconds]): one GoogleTest executable, its
# tests registered one by one. SIGNORINI_SHARED_DIR is where problem and scene files may lie; tests
# that need them skip, by name, when the folder is absent.
function(signorini_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;DEPENDS" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  signorini_test_options(${name})
  signorini_precompile_test(${name})
  target_link_libraries(${name} PRIVATE ${ARG_DEPENDS} GTest::gtest_main)
  target_include_directories(${name} PRIVATE ${SIGNORINI_INCLUDE_DIR} ${PROJECT_SOURCE_DIR})
  target_compile_definitions(${name} PRIVATE
    SIGNORINI_SHARED_DIR="${PROJECT_SOURCE_DIR}/../shared" SIGNORINI_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  set(environment "")
  if("${ARG_SOURCES}" MATCHES "allocation_count.cpp")
    # It counts on all threads, and OpenBLAS's workers allocate when they first run, which on a busy
    # machine is in the middle of a test.
    set(environment ENVIRONMENT OPENBLAS_NUM_THREADS=1)
  endif()
  gtest_discover_tests(${name} TEST_PREFIX "${name}." DISCOVERY_TIMEOUT 120
                       PROPERTIES TIMEOUT ${ARG_TIMEOUT} ${environment})
endfunction()
