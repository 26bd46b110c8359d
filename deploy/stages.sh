# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# Stages of a script with their seconds, by the clock and of CPU; source it after lib.sh.

stage_lines=()
stage_times="$(mktemp)"
trap 'rm -f "$stage_times"' EXIT

# Sets cpu: the CPU seconds of all processes that this shell has waited for. `times` in a pipe, or in $(), would be those of
# a subshell, so it writes to a file.
children_cpu() {
    times >"$stage_times"
    cpu="$(awk 'NR == 2 { for (i = 1; i <= 2; ++i) { split($i, part, /[ms]/); sum += 60 * part[1] + part[2] }
                          printf "%.0f", sum }' "$stage_times")"
}

# stage NAME COMMAND...: runs it and returns its exit code; sets stage_cpu, its CPU seconds.
stage() {
    local name=$1 begin=$SECONDS code=0 before
    shift
    children_cpu
    before=$cpu
    "$@" || code=$?
    children_cpu
    stage_cpu=$((cpu - before))
    stage_lines+=("$(printf '%-26s %7d %9d' "$name" "$((SECONDS - begin))" "$stage_cpu")")
    return "$code"
}

print_stages() {
    printf '\n%-26s %7s %9s\n' "stage" "seconds" "CPU-s"
    printf '%s\n' "${stage_lines[@]}"
}
