# SPDX-License-Identifier: MIT
# One place for what all targets share: language level, warnings, sanitizers, output folders, and the three
# kinds of target (library, program, test). Every target sees the repository root and the generated root, so that
# an include reads like the namespace: "common/wire/pack_buffer.h", "gen/glstate/state.gen.h".

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
# Programs, too, so that they share precompiled headers with the libraries.
set(CMAKE_CXX_COMPILE_OPTIONS_PIE -fPIC)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/lib")

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_SOURCE_DIR}/cmake/cached.sh" "${CMAKE_SOURCE_DIR}")
endif()
find_package(Threads REQUIRED)
# The same for all, so that all can use the same precompiled headers.
add_compile_definitions(BOOST_ASIO_NO_DEPRECATED BOOST_ASIO_SEPARATE_COMPILATION BOOST_BEAST_SEPARATE_COMPILATION)

option(WALLGL_PRECOMPILE "Parse heavy headers once (cmake/precompiled)" ON)
option(WALLGL_UNITY "Compile several sources of a target at once, so that what all include is parsed once" OFF)
set(WALLGL_SANITIZE "" CACHE STRING "Sanitizers, as in -fsanitize=")
option(WALLGL_WERROR "Warnings are errors (the presets say so); off for compilers that nobody has tried" OFF)
set(WALL_GEN_ROOT "${CMAKE_BINARY_DIR}/generated")

# A change compiles its whole batch, and a header that all include an eighth as often: eight is where both are bearable.
set(CMAKE_UNITY_BUILD ${WALLGL_UNITY})
set(CMAKE_UNITY_BUILD_BATCH_SIZE 8)

# Float results must equal those of Mesa's own C code, so no contraction into fused operations.
# GCC's SLP vectorizer merges the packer's pointer updates into one store that stalls (docs/benchmarks.md).
# With GCC -Wconversion is about values, not about signs; so it is with clang.
set(WALL_COMPILE_OPTIONS
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wno-missing-field-initializers
  -Werror=unused-result -ffp-contract=off)
if(WALLGL_WERROR)
  list(APPEND WALL_COMPILE_OPTIONS -Werror)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # ccache wants to know a precompiled header in what the preprocessor makes.
  list(APPEND WALL_COMPILE_OPTIONS -fno-tree-slp-vectorize -fpch-preprocess)
  # GCC 12 gives these two falsely for a moved std::string and for the frames of Asio's coroutines; the others depend on
  # what its optimizer has inlined, also into headers that are not ours: they are said, and no errors.
  list(APPEND WALL_COMPILE_OPTIONS -Wno-array-bounds -Wno-mismatched-new-delete)
  if(WALLGL_UNITY)
    # A coroutine's frame may hold what only its source names; that this source is included says nothing.
    list(APPEND WALL_COMPILE_OPTIONS -Wno-subobject-linkage)
  endif()
  foreach(guess dangling-pointer free-nonheap-object maybe-uninitialized restrict stringop-overflow stringop-overread
                use-after-free)
    list(APPEND WALL_COMPILE_OPTIONS -Wno-error=${guess})
  endforeach()
endif()

function(wall_setup target)
  target_include_directories(${target} PUBLIC "${CMAKE_SOURCE_DIR}" "${WALL_GEN_ROOT}")
  target_compile_options(${target} PRIVATE ${WALL_COMPILE_OPTIONS})
  if(WALLGL_SANITIZE MATCHES thread AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Asio has fences, which this sanitizer does not follow (it may report too much there, never too little).
    target_compile_options(${target} PRIVATE -Wno-tsan)
  endif()
  if(WALLGL_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${WALLGL_SANITIZE} -fno-omit-frame-pointer
      -fno-sanitize-recover=undefined)
    target_link_options(${target} PRIVATE -fsanitize=${WALLGL_SANITIZE})
  endif()
endfunction()

# wall_precompile(target header): the target's files find `header` parsed. The headers of cmake/precompiled are compiled
# once for all targets that name them; any other is the target's own.
function(wall_precompile target header)
  if(NOT WALLGL_PRECOMPILE)
    return()
  endif()
  if(header MATCHES "^cmake/precompiled/(.*)[.]h$")
    target_precompile_headers(${target} REUSE_FROM wall_precompiled_${CMAKE_MATCH_1})
  else()
    target_precompile_headers(${target} PRIVATE <${header}>)
  endif()
endfunction()

# wall_precompiled(name [LINK libs...] [NEEDS targets...]): compiles cmake/precompiled/NAME.h after these targets.
function(wall_precompiled name)
  cmake_parse_arguments(ARG "" "" "LINK;NEEDS" ${ARGN})
  set(source "${CMAKE_BINARY_DIR}/precompiled/${name}.cpp")
  file(CONFIGURE OUTPUT "${source}" CONTENT "// Precompiled headers belong to a target, and a target has a source.\n")
  add_library(wall_precompiled_${name} OBJECT EXCLUDE_FROM_ALL "${source}")
  wall_setup(wall_precompiled_${name})
  target_link_libraries(wall_precompiled_${name} PRIVATE ${ARG_LINK})
  target_precompile_headers(wall_precompiled_${name} PRIVATE <cmake/precompiled/${name}.h>)
  if(ARG_NEEDS)
    add_dependencies(wall_precompiled_${name} ${ARG_NEEDS})
  endif()
endfunction()

# wall_library(name SOURCES... [LINK libs...])
function(wall_library name)
  cmake_parse_arguments(ARG "" "" "LINK" ${ARGN})
  if(ARG_UNPARSED_ARGUMENTS)
    add_library(${name} STATIC ${ARG_UNPARSED_ARGUMENTS})
    wall_setup(${name})
    target_link_libraries(${name} PUBLIC ${ARG_LINK})
  else()
    add_library(${name} INTERFACE)
    target_include_directories(${name} INTERFACE "${CMAKE_SOURCE_DIR}" "${WALL_GEN_ROOT}")
    target_link_libraries(${name} INTERFACE ${ARG_LINK})
  endif()
endfunction()

# wall_program(name SOURCES... [LINK libs...])
function(wall_program name)
  cmake_parse_arguments(ARG "" "" "LINK" ${ARGN})
  add_executable(${name} ${ARG_UNPARSED_ARGUMENTS})
  wall_setup(${name})
  target_link_libraries(${name} PRIVATE ${ARG_LINK} Threads::Threads)
endfunction()

# wall_alone(SOURCES...): not in one batch with others, because they have words of their own for the same thing.
function(wall_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# wall_test(name [BATCHED] SOURCES... [LINK libs...] [LABELS labels...]): a GoogleTest program, registered with CTest.
# Its sources are compiled each alone, since tests name what they need as is shortest; BATCHED: as those of libraries.
function(wall_test name)
  cmake_parse_arguments(ARG "BATCHED" "" "LINK;LABELS" ${ARGN})
  find_package(GTest REQUIRED)
  wall_program(${name} ${ARG_UNPARSED_ARGUMENTS} LINK ${ARG_LINK} GTest::gtest GTest::gmock GTest::gtest_main)
  wall_precompile(${name} cmake/precompiled/test.h)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/tests")
  if(NOT ARG_BATCHED)
    set_target_properties(${name} PROPERTIES UNITY_BUILD OFF)
  endif()
  add_test(NAME ${name} COMMAND ${name})
  if(NOT ARG_LABELS)
    set(ARG_LABELS unit)
  endif()
  set(limit 120)  # seconds; at least twice what the slowest one takes, sanitized three times
  if(WALLGL_SANITIZE)
    set(limit 600)
  endif()
  set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${limit}
    ENVIRONMENT "WALLGL_CACHE=off")  # a test's questions are its own
  # `unit_tests`, `integration_tests`, ...: all programs of a label, for builds that want only those.
  foreach(label ${ARG_LABELS})
    if(NOT TARGET ${label}_tests)
      add_custom_target(${label}_tests)
    endif()
    add_dependencies(${label}_tests ${name})
  endforeach()
endfunction()
