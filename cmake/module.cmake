# SPDX-License-Identifier: Apache-2.0
# treefarm_module(NAME SOURCES ... LINKS ... PRIVATE_LINKS ...)
# A module is a static library `tf_NAME`. LINKS are the modules (and libraries) that its headers may use; a module that
# is not linked is not on the include path of its dependents' link line, and tests/unit/tree/arrows_test checks the includes too.
function(treefarm_module NAME)
    cmake_parse_arguments(MODULE "" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
    add_library(tf_${NAME} STATIC ${MODULE_SOURCES})
    target_include_directories(tf_${NAME} PUBLIC ${PROJECT_SOURCE_DIR})
    target_link_libraries(tf_${NAME} PUBLIC treefarm_flags ${MODULE_LINKS} PRIVATE ${MODULE_PRIVATE_LINKS})
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
