# SPDX-License-Identifier: Apache-2.0
# Embree 3 or 4, whichever is there, as the library treefarm_embree; worker/geometry/embree_api.h hides which.
set(TREEFARM_EMBREE "auto" CACHE STRING "version of Embree: 3, 4, or auto, which takes 3 where it is installed, else 4")
set_property(CACHE TREEFARM_EMBREE PROPERTY STRINGS auto 3 4)

if(TREEFARM_EMBREE STREQUAL "auto")
    set(versions 3 4)
elseif(TREEFARM_EMBREE MATCHES "^[34]$")
    set(versions ${TREEFARM_EMBREE})
else()
    message(FATAL_ERROR "TREEFARM_EMBREE is \"${TREEFARM_EMBREE}\"; set it to 3, 4 or auto")
endif()
foreach(version IN LISTS versions)
    find_package(embree ${version} QUIET)
    if(embree_FOUND)
        break()
    endif()
endforeach()
if(NOT embree_FOUND)
    list(JOIN versions " or " wanted)
    message(FATAL_ERROR "Embree ${wanted} is missing: install libembree-dev, or give the folder of an installation: "
                        "-DCMAKE_PREFIX_PATH=FOLDER")
endif()
message(STATUS "Embree ${embree_VERSION}")

add_library(treefarm_embree INTERFACE)
target_link_libraries(treefarm_embree INTERFACE embree)
target_compile_definitions(treefarm_embree INTERFACE TREEFARM_EMBREE=${embree_VERSION_MAJOR})
