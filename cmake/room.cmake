# SPDX-License-Identifier: Apache-2.0
# treefarm_room(NAME SOURCES ... LINKS ... PRIVATE_LINKS ...)
# A room is a static library `tf_NAME`. LINKS are the rooms (and libraries) its headers may use; a room that is not
# linked is not on the include path of its dependents' link line, and tests/unit/arrows_test checks the includes too.
function(treefarm_room NAME)
    cmake_parse_arguments(ROOM "" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
    add_library(tf_${NAME} STATIC ${ROOM_SOURCES})
    target_include_directories(tf_${NAME} PUBLIC ${PROJECT_SOURCE_DIR})
    target_link_libraries(tf_${NAME} PUBLIC treefarm_flags ${ROOM_LINKS} PRIVATE ${ROOM_PRIVATE_LINKS})
endfunction()
