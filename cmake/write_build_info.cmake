# SPDX-License-Identifier: Apache-2.0
# Writes OUTPUT, cli/build_info.h's strings, when they differ from what stands there: after a commit only the program is
# linked again. cmake -DOUTPUT=... -DSOURCE_DIR=... -DOPTIONS=... -P THIS_FILE
set(source "release")  # an unpacked archive, without git's folder
find_program(git git)
if(git AND EXISTS "${SOURCE_DIR}/.git")
    # Also of a tree that somebody else owns, as in a container.
    execute_process(COMMAND ${git} -c safe.directory=${SOURCE_DIR} -C ${SOURCE_DIR} describe --always --dirty --abbrev=12
                    OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
    if(NOT failed)
        set(source "${described}")
    endif()
endif()
set(text "#include \"cli/build_info.h\"

namespace treefarm {

const char* build_source() {
    return \"${source}\";
}

const char* build_options() {
    return \"${OPTIONS}\";
}

}  // namespace treefarm
")
set(before "")
if(EXISTS "${OUTPUT}")
    file(READ "${OUTPUT}" before)
endif()
if(NOT before STREQUAL text)
    file(WRITE "${OUTPUT}" "${text}")
endif()
