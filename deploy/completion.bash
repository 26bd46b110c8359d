# SPDX-License-Identifier: Apache-2.0
# Completion of treefarm for bash: commands and options by the program's own --help, keys of --set by `treefarm keys`.
# shellcheck shell=bash

# Words that a command's --help lists in its first column: _treefarm_words PATTERN COMMAND...
_treefarm_words() {
    local pattern=$1
    shift
    "$@" --help 2>/dev/null | grep -oE -- "^ +$pattern" | grep -oE -- '-{0,2}[A-Za-z][A-Za-z-]*'
}

_treefarm() {
    local program=${COMP_WORDS[0]} word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=""
    local -i k
    COMPREPLY=()
    for ((k = 1; k < COMP_CWORD; ++k)); do
        # What launch starts is a command of its own.
        if [[ ${COMP_WORDS[k]} == -- && $command == launch ]]; then
            command=""
        elif [[ ${COMP_WORDS[k]} != -* && -z $command ]]; then
            command=${COMP_WORDS[k]}
        fi
    done
    if [[ -z $command ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_treefarm_words '[a-z]+' "$program")" -- "$word")
    elif [[ $before == --set ]]; then
        mapfile -t COMPREPLY < <(compgen -S = -W "$("$program" keys 2>/dev/null | grep -oE '^[a-z_]+\.[a-z_]+')" -- "$word")
        compopt -o nospace 2>/dev/null
    elif [[ $word == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_treefarm_words '-.*' "$program" "$command" | grep '^-')" -- "$word")
    fi
}

# Files where it has nothing to say: scenes, jobs, studies and run directories.
complete -o default -F _treefarm treefarm
