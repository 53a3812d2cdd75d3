# Sourced by the other scripts: where the project is, how many jobs, how to say what is being done and
# what it took.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

jobs=${SIGNORINI_JOBS:-$(nproc)}
part="start"
part_began=0
part_cpu=0
parts=""  # what each part took, a line each

# CPU seconds of all that this script has waited for.
cpu_seconds() {
  local stat
  read -ra stat <"/proc/$$/stat"
  echo $(((stat[15] + stat[16]) / 100))
}

end_part() {
  local cpu
  cpu=$(cpu_seconds)
  parts+=$(printf '%7d %7d   %s' $((SECONDS - part_began)) $((cpu - part_cpu)) "$part")$'\n'
  part_began=$SECONDS
  part_cpu=$cpu
}

step() {  # step NAME: what the script does from here on; named again if it fails
  [ "$part" = start ] || end_part
  part=$1
  printf '\n== %s (%s)\n' "$part" "$(date +%H:%M:%S)"
}

report() {
  local code=$?
  end_part
  printf '\n      s   CPU s   part of %s\n%s' "$(basename "$0")" "$parts"
  if [ "$code" -ne 0 ]; then
    printf '\n%s: FAILED in: %s (exit code %d)\n' "$(basename "$0")" "$part" "$code" >&2
  fi
}
trap report EXIT

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
