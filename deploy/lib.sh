# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# Shared by the scripts of this folder; source it.

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"

fail() {
    echo "deploy/$(basename "$0"): $*" >&2
    exit 1
}

# configure PRESET: only when it has not been configured; ninja reconfigures by itself when a CMake file changes. Thirty files
# are compiled as one, which is fastest from nothing; who edits has six by `cmake --preset release`.
configure() {
    if [[ ! -f "$root/build/$1/build.ninja" ]]; then
        (cd "$root" && cmake --preset "$1" -DTREEFARM_UNITY_FILES=30) || fail "cmake could not configure the preset '$1' (see above)"
    fi
}

# build PRESET [TARGET...]
build() {
    local preset=$1
    shift
    configure "$preset"
    local targets=()
    (($# == 0)) || targets=(--target "$@")
    (cd "$root" && cmake --build --preset "$preset" "${targets[@]}") ||
        fail "the build of the preset '$preset' failed (see above); if it was configured long ago, remove build/$preset"
}

# tell_build PRESET TARGET: what building the target takes, before it starts; of a build that is configured. It counts the files that Ninja
# would make and that are not there: a dry run of Ninja lists CMake's own step alone. Where thirty files are compiled as one, a step takes
# a core some 11 seconds (bench/build_cost measures it), less where ccache has its result.
tell_build() {
    local folder="$root/build/$1" steps=0 cores file
    cores="$(nproc)"
    while read -r file; do
        [[ -e "$folder/$file" ]] || ((++steps))
    done < <(ninja -C "$folder" -t inputs "$2" | grep -E '\.(o|a|gch)$'; echo "$2")
    if ((steps == 0)); then
        echo "deploy/$(basename "$0"): the program is there; what has changed is built again"
    else
        echo "deploy/$(basename "$0"): to build: $steps steps, about $((steps * 11 / cores / 60 + 1)) min on $cores cores" \
            "that do nothing else"
    fi
}

# Open MPI on this machine alone: it neither listens nor speaks beyond the loopback device.
use_loopback() {
    export OMPI_MCA_btl_tcp_if_include=lo OMPI_MCA_oob_tcp_if_include=lo PMIX_MCA_ptl_tcp_if_include=lo
    if ((EUID == 0)); then
        export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
    fi
}
