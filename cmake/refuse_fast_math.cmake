# SPDX-License-Identifier: Apache-2.0
# -ffast-math and its parts are refused, in CMAKE_CXX_FLAGS and those of every kind of build. What slips through here
# fails in common/math/vec.h. Also a script of its own, for tests/stability: cmake -DCMAKE_CXX_FLAGS=... -P THIS_FILE
foreach(flag IN ITEMS -ffast-math -Ofast -funsafe-math-optimizations -fassociative-math)
    if("${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_RELEASE} ${CMAKE_CXX_FLAGS_DEBUG}" MATCHES "${flag}")
        message(FATAL_ERROR "${flag} is refused: it reorders sums, so results would no longer be the same bits "
                            "on every worker. Remove it from CMAKE_CXX_FLAGS.")
    endif()
endforeach()
