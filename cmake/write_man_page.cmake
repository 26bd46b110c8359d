# SPDX-License-Identifier: Apache-2.0
# Writes the man page of a command of the program from its --help:
# cmake -DHELP2MAN=... -DPROGRAM=... -DCOMMAND=render -DVERSION=... -DOUTPUT=... -P THIS_FILE
get_filename_component(folder ${OUTPUT} DIRECTORY)
file(MAKE_DIRECTORY ${folder})
set(ENV{LC_ALL} C.UTF-8)
execute_process(COMMAND ${PROGRAM} ${COMMAND} --help OUTPUT_VARIABLE help RESULT_VARIABLE failed)
if(failed)
    message(FATAL_ERROR "${PROGRAM} ${COMMAND} --help failed: ${failed}")
endif()
string(REGEX MATCH "^[^\n]*" title "${help}")
# help2man asks a program of one word, and takes its name for the page's.
get_filename_component(name ${OUTPUT} NAME_WE)
set(asked ${folder}/asked/${name})
file(WRITE ${asked} "#!/bin/sh\nexec \"${PROGRAM}\" ${COMMAND} \"$@\"\n")
file(CHMOD ${asked} PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
execute_process(
    COMMAND ${HELP2MAN} --no-info --section=1 --version-string=${VERSION} --name=${title} --output=${OUTPUT} ${asked}
    RESULT_VARIABLE failed)
if(failed)
    message(FATAL_ERROR "help2man failed for ${name}: ${failed}")
endif()
