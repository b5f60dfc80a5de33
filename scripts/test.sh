#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what is missing, builds, and runs every test: scripts/test.sh [STAGE...], stages as listed below.
# Ends with CTest's own summary of each stage; exit code 1 if anything failed. Seven run only when they are named:
# golden-all and conformance-all, of which the usual run takes samples (more than ten minutes, hours); faults and soak,
# 300 faults on a wall of machines and an hour of them; packages, which builds the Debian packages and runs a wall of
# machines that have them; alone, which compiles each source by itself, so that a missing include fails; and fresh,
# which does everything once more on a clean Debian 12 (scripts/fresh.sh).
set -uo pipefail
cd "$(dirname "$0")/.."
readonly all_stages=(release golden conformance asan tsan fuzz)
readonly on_request=(golden-all conformance-all faults soak packages alone fresh)
readonly summaries="build/test-summaries"
readonly tsan_targets=(walld tileserver wallctl control_plane_test)
begin=$SECONDS
failed=()
ahead=""  # the process group that builds for a stage to come
trap '[[ -z $ahead ]] || kill -- "-$ahead" 2>/dev/null' EXIT

say() { printf '\n== test: %s (%d:%02d)\n' "$1" $(((SECONDS - begin) / 60)) $(((SECONDS - begin) % 60)); }

# build PRESET [TARGET...]
build() { scripts/build.py --name "test: building ($1)" "$@"; }

# run STAGE PRESET CTEST-ARGS...: its summary is kept for the end.
run() {
  local stage=$1 preset=$2; shift 2
  ctest --test-dir "build/$preset" --output-on-failure "$@" 2>&1 | tee "$summaries/$stage.log"
  local result=${PIPESTATUS[0]}
  [[ $result -eq 0 ]] || failed+=("$stage")
}

stage_release() {
  say "building (release)"
  build release || { failed+=(release); return; }
  say "unit, integration and lint tests"
  run release release -LE 'golden|conformance|fuzz|browser' -j 2
}

# The sanitized builds of the stages to come. With nothing cached they take as long as all tests; golden and conformance
# tests wait a quarter of their time, so they are built beside those, behind them in the line for the processors.
build_ahead() {
  [[ -z $ahead && " ${stages[*]} " == *" asan tsan "* ]] || return
  # shellcheck disable=SC2016  # that shell's own arguments
  setsid nice -n 10 bash -c 'scripts/build.py asan unit_tests fuzzers; scripts/build.py tsan "$@"' - \
    "${tsan_targets[@]}" >"$summaries/building-ahead.log" 2>&1 &
  ahead=$!
}

# Two builds in one folder at the same time would disturb each other. What has failed is built once more, and says why.
wait_for_ahead() {
  [[ -n $ahead ]] && wait "$ahead"
  ahead=""
}

stage_golden() {
  say "golden tests: programs on plain Mesa and on walls, frame by frame; the status page in a browser"
  build release || { failed+=(golden); return; }
  build_ahead
  run golden release -L 'golden|browser'
}

stage_golden-all() {
  say "golden tests: all recordings on each wall"
  build release || { failed+=(golden-all); return; }
  local wall
  for wall in mesa 1x1 2x2 3x2; do
    WALLGL_BUILD="$PWD/build/release" tests/golden/golden.py --tiles "$wall" \
      --report "build/release/test-output/golden-all-$wall" \
      --references build/release/test-output/golden-references || failed+=("golden-all ($wall)")
  done
  WALLGL_BUILD="$PWD/build/release" tests/golden/healing.py --all || failed+=("golden-all (healing)")
}

stage_conformance() {
  say "conformance tests: piglit on walls; what fails there, on plain Mesa"
  build release || { failed+=(conformance); return; }
  run conformance release -L conformance
}

stage_conformance-all() {
  say "conformance tests: all that the walls offer, also what the usual run takes samples of"
  build release || { failed+=(conformance-all); return; }
  local wall
  for wall in "1x1 1280x1024" "4x3 144x150" "1x1 1280x1024 --fbo" "4x3 144x150 --fbo"; do
    # shellcheck disable=SC2086  # two or three words
    set -- $wall
    WALLGL_BUILD="$PWD/build/release" tests/conformance/piglit.py --tiles "$1" --tile-size "$2" ${3:+"$3"} \
      --report "build/release/test-output/conformance-all-$1${3:-}" || failed+=("conformance-all ($1${3:+ $3})")
  done
}

faults() {
  say "$1"
  build release || { failed+=("$2"); return; }
  WALLGL_BUILD="$PWD/build/release" tests/integration/machines/faults.py "${@:3}" --pictures "$summaries" ||
    failed+=("$2")
}

stage_faults() { faults "300 faults on a wall of machines (half an hour)" faults --count 300; }
stage_soak() { faults "an hour of faults on a wall of machines" soak --for 3600; }

stage_asan() {
  wait_for_ahead
  say "building the unit tests and fuzzers (clang, address and undefined behaviour sanitizers)"
  build asan unit_tests fuzzers || { failed+=(asan); return; }
  say "unit tests under these sanitizers"
  # Mesa keeps some memory until the process ends.
  LSAN_OPTIONS="suppressions=$PWD/tests/support/lsan.supp" run asan asan -L unit -j 2
}

stage_tsan() {
  say "building the daemons (thread sanitizer)"
  build release wallrun wallgl_vendor || { failed+=(tsan); return; }
  build tsan "${tsan_targets[@]}" || { failed+=(tsan); return; }
  say "a short wall under the thread sanitizer"
  run tsan tsan -R '^(control_plane_test|threads_test)$'
}

stage_fuzz() {
  say "building the fuzzers (clang, address and undefined behaviour sanitizers)"
  build asan fuzzers || { failed+=(fuzz); return; }
  say "fuzzers, 60 seconds each"
  run fuzz asan -L fuzz -j 4  # more than there are processors: what counts is how long each runs
}

stage_packages() {
  say "building the Debian packages"
  scripts/packages.sh || { failed+=(packages); return; }
  say "machines on which they are installed, upgraded and purged"
  /usr/bin/python3 tests/packages/packages_test.py -v || failed+=(packages)
}

stage_alone() {
  say "building each source by itself (debug)"
  build debug || failed+=(alone)
}

stage_fresh() {
  say "the commands of the README on a clean Debian 12"
  scripts/fresh.sh && return
  failed+=(fresh)
}

stages=("$@")
[[ $# -gt 0 ]] || stages=("${all_stages[@]}")
for stage in "${stages[@]}"; do
  [[ " ${all_stages[*]} ${on_request[*]} " == *" $stage "* ]] ||
    { echo "test: unknown stage '$stage'; there are: ${all_stages[*]}, and on request ${on_request[*]}" >&2; exit 2; }
done

say "installing what is missing"
scripts/install-deps.sh test || exit 2
rm -rf "$summaries" && mkdir -p "$summaries"
for stage in "${stages[@]}"; do "stage_$stage"; done

say "done"
for stage in "${stages[@]}"; do
  [[ -f "$summaries/$stage.log" ]] || continue
  printf '%s:\n' "$stage"
  sed -n '/tests passed/,$p' "$summaries/$stage.log" | grep -v '^$'
done
if [[ ${#failed[@]} -gt 0 ]]; then
  echo "FAILED: ${failed[*]}"
  exit 1
fi
