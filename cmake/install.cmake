# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` puts where: program, man pages, completion, documentation, examples.
include(GNUInstallDirs)

install(TARGETS treefarm RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(FILES deploy/completion.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME treefarm)

# Pages keep their places, so that links between them hold.
install(FILES README.md CHANGELOG.md CONTRIBUTING.md CITATION.cff LICENSE NOTICE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY bench/log DESTINATION ${CMAKE_INSTALL_DOCDIR}/bench)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)  # where Debian looks for it
# Not below doc, which minimal systems leave out of packages.
install(DIRECTORY configs DESTINATION ${CMAKE_INSTALL_DATADIR}/treefarm PATTERN "__pycache__" EXCLUDE)

# What a queue runs; programs keep their rights.
install(DIRECTORY deploy/slurm deploy/opencue deploy/flamenco deploy/kubernetes DESTINATION ${CMAKE_INSTALL_DATADIR}/treefarm/deploy
        USE_SOURCE_PERMISSIONS PATTERN "__pycache__" EXCLUDE)
install(FILES deploy/hostfile DESTINATION ${CMAKE_INSTALL_DATADIR}/treefarm/deploy)

# Man pages say what --help says. They are written where they are installed, whatever target was built. A sanitizer's program may not
# run as it is.
find_program(TREEFARM_HELP2MAN help2man)
if(NOT TREEFARM_HELP2MAN)
    message(STATUS "no man pages will be installed: help2man is missing")
elseif(NOT TREEFARM_SANITIZE AND NOT TREEFARM_FUZZ)
    set(man ${PROJECT_BINARY_DIR}/man)
    install(CODE "
        file(REMOVE_RECURSE \"${man}\")
        foreach(command IN ITEMS \"\" render resume launch join serve plan check compare convert inspect study report keys)
            string(JOIN \"-\" name treefarm \${command})
            execute_process(COMMAND \"${CMAKE_COMMAND}\" \"-DHELP2MAN=${TREEFARM_HELP2MAN}\" \"-DPROGRAM=$<TARGET_FILE:treefarm>\"
                    -DCOMMAND=\${command} -DVERSION=${PROJECT_VERSION} \"-DOUTPUT=${man}/\${name}.1\"
                    -P \"${PROJECT_SOURCE_DIR}/cmake/write_man_page.cmake\" RESULT_VARIABLE failed)
            if(failed)
                message(FATAL_ERROR \"the man page \${name}.1 could not be written (see above)\")
            endif()
        endforeach()")
    install(DIRECTORY ${man}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 FILES_MATCHING PATTERN "*.1" PATTERN "asked" EXCLUDE)
endif()

# Editors and clang-tidy look for it at the root; of builds that compile each file by itself the first one has it.
if(CMAKE_EXPORT_COMPILE_COMMANDS AND NOT TREEFARM_UNITY AND NOT EXISTS ${PROJECT_SOURCE_DIR}/compile_commands.json)
    file(CREATE_LINK ${PROJECT_BINARY_DIR}/compile_commands.json ${PROJECT_SOURCE_DIR}/compile_commands.json
         RESULT ignored SYMBOLIC)  # not every file system can
endif()
