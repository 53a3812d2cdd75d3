# Sourced by the other scripts: where the project is, how many jobs, how to say what is being done.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

jobs=${SIGNORINI_JOBS:-$(nproc)}
part="start"

step() {  # step NAME: what the script does from here on; named again if it fails
  part=$1
  printf '\n== %s (%s)\n' "$part" "$(date +%H:%M:%S)"
}

report_failure() {
  local code=$?
  if [ "$code" -ne 0 ]; then
    printf '\n%s: FAILED in: %s (exit code %d)\n' "$(basename "$0")" "$part" "$code" >&2
  fi
}
trap report_failure EXIT

# configure_and_build PRESET [TARGET ...]: configures once, then builds only what changed.
configure_and_build() {
  local preset=$1
  shift
  if [ ! -f "build/$preset/build.ninja" ]; then
    step "configure $preset"
    cmake --preset "$preset" -DSIGNORINI_PRECOMPILE=ON
  fi
  step "build $preset${1:+: $*}"
  cmake --build "build/$preset" -j "$jobs" ${1:+--target "$@"}
}
