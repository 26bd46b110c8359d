# SPDX-License-Identifier: Apache-2.0
# How every target is compiled, decided here alone (bench/log/build.md has what each measure saves):
# - Headers of others that many files include are parsed once. Each file still includes what it uses:
#   -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON builds without.
# - What traces, learns or sums stays at -O3, alone in its file: all of worker, and what it calls. The rest is cold: -O2, and
#   tests -O1. A linker keeps one copy of an inline function that several files emit, and it may be a cold file's, so a cold file
#   must not instantiate what a path runs through (bench/effect_cost counts instructions). Levels change no bit
#   (-ffp-contract=off; tests/tools/same_images).
# - Files are compiled several at a time, but kernels: our own headers are most of what is parsed, and their inline functions
#   most of what is generated. Six suit who edits; deploy/ builds from nothing with thirty. -DTREEFARM_UNITY=OFF compiles each
#   by itself, as editors and clang-tidy want it (preset by-file).
option(TREEFARM_UNITY "compile several files at a time" ON)
option(TREEFARM_UNITY_KERNELS "also those of kernels, whose speed depends on what is inlined" OFF)
set(TREEFARM_UNITY_FILES 6 CACHE STRING "files that are compiled as one")
set(TREEFARM_COLD_LEVEL "" CACHE STRING "level of cold files; empty: -O2, and -O1 for tests, in a release build by g++")

# Modules whose speed matters stay as they are. The others, and every test, are cold.
set(TREEFARM_HOT base film decide guiding image metrics textures geometry shading lights camera trace_scene integrators tools worker)
list(TRANSFORM TREEFARM_HOT PREPEND tf_)
set(TREEFARM_KERNELS tf_shading tf_trace_scene tf_integrators)

file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/precompiled.cpp CONTENT "// carries the precompiled headers\n")
function(treefarm_precompiled NAME)
    cmake_parse_arguments(PRECOMPILED "" "" "LINKS;HEADERS" ${ARGN})
    add_library(${NAME} OBJECT ${PROJECT_BINARY_DIR}/precompiled.cpp)
    target_link_libraries(${NAME} PRIVATE treefarm_flags spdlog::spdlog nlohmann_json::nlohmann_json Imath::Imath
                          ${PRECOMPILED_LINKS})
    target_precompile_headers(${NAME} PRIVATE ${PRECOMPILED_HEADERS}
        <Imath/ImathBox.h> <Imath/ImathColor.h> <Imath/ImathMatrix.h> <Imath/ImathVec.h>
        <nlohmann/json.hpp> <spdlog/fmt/fmt.h> <spdlog/spdlog.h>
        <algorithm> <array> <chrono> <cmath> <filesystem> <fstream> <functional> <map> <memory> <mutex> <numeric>
        <optional> <random> <set> <span> <sstream> <string> <thread> <variant> <vector>)
endfunction()
treefarm_precompiled(tf_precompiled)

# treefarm_targets(OUT DIRECTORY): libraries and programs of a folder and those below it.
function(treefarm_targets OUT DIRECTORY)
    get_property(found DIRECTORY ${DIRECTORY} PROPERTY BUILDSYSTEM_TARGETS)
    get_property(below DIRECTORY ${DIRECTORY} PROPERTY SUBDIRECTORIES)
    foreach(folder IN LISTS below)
        treefarm_targets(more ${folder})
        list(APPEND found ${more})
    endforeach()
    set(${OUT} ${found} PARENT_SCOPE)
endfunction()

# Call once every target is there.
function(treefarm_compile_all)
    set(program_level ${TREEFARM_COLD_LEVEL})
    set(test_level ${TREEFARM_COLD_LEVEL})
    if(NOT TREEFARM_COLD_LEVEL AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_BUILD_TYPE STREQUAL "Release")
        set(program_level -O2)
        set(test_level -O1)
    endif()
    treefarm_targets(targets ${PROJECT_SOURCE_DIR})
    foreach(target IN LISTS targets)
        get_target_property(type ${target} TYPE)
        get_target_property(folder ${target} SOURCE_DIR)
        if(NOT type MATCHES "^(STATIC_LIBRARY|EXECUTABLE)$")
            continue()
        endif()
        string(REPLACE "${PROJECT_SOURCE_DIR}/" "" folder "${folder}")
        get_target_property(links ${target} LINK_LIBRARIES)
        if(links MATCHES "tf_test_support|tf_mpi_test_support|GTest")
            target_precompile_headers(${target} REUSE_FROM tf_precompiled_tests)
        else()
            target_precompile_headers(${target} REUSE_FROM tf_precompiled)
        endif()
        if(NOT target IN_LIST TREEFARM_HOT AND NOT folder STREQUAL "bench")
            if(folder MATCHES "^tests")
                target_compile_options(${target} PRIVATE ${test_level})
            else()
                target_compile_options(${target} PRIVATE ${program_level})
            endif()
        endif()
        if(NOT folder STREQUAL "bench" AND (TREEFARM_UNITY_KERNELS OR NOT target IN_LIST TREEFARM_KERNELS))
            set_target_properties(${target} PROPERTIES UNITY_BUILD ${TREEFARM_UNITY}
                                  UNITY_BUILD_BATCH_SIZE ${TREEFARM_UNITY_FILES})
        endif()
    endforeach()
endfunction()
