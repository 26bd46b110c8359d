# SPDX-License-Identifier: Apache-2.0
# treefarm_module(NAME SOURCES ... LINKS ... PRIVATE_LINKS ...)
# A module is a static library `tf_NAME`. LINKS are the modules (and libraries) that its headers may use; a module that
# is not linked is not on the include path of its dependents' link line, and tests/unit/tree/arrows_test checks the includes too.
function(treefarm_module NAME)
    cmake_parse_arguments(MODULE "" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
    set(target tf_${NAME})
    set(in_all)
    if(TREEFARM_COLD_OF AND NAME IN_LIST TREEFARM_COLD_MODULES)
        cmake_path(RELATIVE_PATH CMAKE_CURRENT_BINARY_DIR BASE_DIRECTORY ${PROJECT_BINARY_DIR} OUTPUT_VARIABLE folder)
        add_library(${target} STATIC IMPORTED GLOBAL)
        set_target_properties(${target} PROPERTIES IMPORTED_LOCATION ${TREEFARM_COLD_OF}/${folder}/lib${target}.a)
        target_link_libraries(${target} INTERFACE treefarm_flags ${MODULE_LINKS} ${MODULE_PRIVATE_LINKS})
        string(APPEND target _unbuilt)
        set(in_all EXCLUDE_FROM_ALL)  # its compile commands are there, for tests/tools/syntax_pass
    endif()
    add_library(${target} STATIC ${in_all} ${MODULE_SOURCES})
    target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR})
    target_link_libraries(${target} PUBLIC treefarm_flags ${MODULE_LINKS} PRIVATE ${MODULE_PRIVATE_LINKS})
endfunction()

# treefarm_folders(NAME IN ... LINKS ... PRIVATE_LINKS ...)
# A module of all sources below folders of the current one. IN: the folders, where they are not called like the module.
function(treefarm_folders NAME)
    cmake_parse_arguments(MODULE "" "" "IN;LINKS;PRIVATE_LINKS" ${ARGN})
    if(NOT MODULE_IN)
        set(MODULE_IN ${NAME})
    endif()
    list(TRANSFORM MODULE_IN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
    list(TRANSFORM MODULE_IN APPEND /*.cpp)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${MODULE_IN})
    treefarm_module(${NAME} SOURCES ${sources} LINKS ${MODULE_LINKS} PRIVATE_LINKS ${MODULE_PRIVATE_LINKS})
endfunction()
