#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what Debian 12 lacks for a purpose, as root or with sudo: scripts/install-deps.sh [--list] [PURPOSE]
#   demo      to build the wall's own programs and run scripts/demo.sh
#   packages  that, and to make Debian packages (scripts/packages.sh)
#   build     demo, and to build everything: tests, benchmarks, wallview, the sanitizer builds
#   test      all of these, and what the tests start: all of scripts/test.sh (if nothing is named)
# --list prints the packages of the purpose instead of installing them.
set -euo pipefail

demo=(
  g++ cmake ninja-build ccache pkg-config git python3
  khronos-api                        # gl.xml, from which much of the code is generated
  libglvnd-dev libgl-dev libegl-dev libglx-dev libosmesa6-dev
  libx11-dev libx11-xcb-dev libxcb1-dev libxrandr-dev libxss-dev
  libdrm-dev libgbm-dev              # monitors without an X server
  libboost1.81-dev libprotobuf-dev protobuf-compiler libprotozero-dev
  libexpected-dev libspdlog-dev libfmt-dev libtomlplusplus-dev libcli11-dev nlohmann-json3-dev
  libopencv-core-dev libopencv-imgproc-dev libopencv-imgcodecs-dev libopencv-calib3d-dev
  libsystemd-dev prometheus-cpp-dev
  libzip-dev libpugixml-dev          # MPCDI files of projectors
  liblz4-dev libzstd-dev             # frame codecs
  libssl-dev                         # content hashes
  glslang-dev                        # the parser of shaders
  libmeshoptimizer-dev               # the order of triangles
  libgl1 libegl1 libgl1-mesa-dri libglx-mesa0 libegl-mesa0 libosmesa6
  xvfb xauth procps
  mesa-utils xscreensaver-gl-extra   # glxgears, atlantis
)
wallview=(libsdl2-dev)
packages=(
  debhelper help2man                 # help2man: manual pages out of --help
)
build=(
  libgtest-dev libgmock-dev libbenchmark-dev
  libavcodec-dev libavutil-dev       # only benchmarks: FFmpeg's codecs beside ours
  libglu1-mesa-dev
  clang-16 libclang-rt-16-dev        # sanitizer builds and fuzzers
)
test=(
  clang-format                       # lint
  xscreensaver-gl rss-glx glmark2-x11 glmark2-es2-x11 apitrace apitrace-tracers
  piglit                             # the conformance tests
  ffmpeg                             # decodes what our codecs write, and the other way round
  x11-utils x11-xserver-utils        # xprop, xwininfo; xrandr: monitors of a display that has none
  xterm fonts-dejavu-core            # the text desktop of the codec benchmark
  python3-numpy python3-opencv python3-jsonschema python3-yaml python3-prometheus-client curl systemd
  iproute2 openssl                   # walls of several machines: network namespaces, keys of strangers
  mmdebstrap                         # clean machines: the stages `fresh` and `packages`
  lintian systemd-container ansible-core openssh-client   # the stage `packages`
  chromium                           # the status page in a real browser
)
# Node.js may come from elsewhere, with npm in it; Debian's npm does not go with that.
command -v node >/dev/null || test+=(nodejs)
command -v npm >/dev/null || test+=(npm)

list=""
[[ ${1:-} != --list ]] || { list=1; shift; }
purpose=${1:-test}
case "$purpose" in
  demo) wanted=("${demo[@]}") ;;
  packages) wanted=("${demo[@]}" "${wallview[@]}" "${packages[@]}") ;;
  build) wanted=("${demo[@]}" "${wallview[@]}" "${build[@]}") ;;
  test) wanted=("${demo[@]}" "${wallview[@]}" "${packages[@]}" "${build[@]}" "${test[@]}") ;;
  *) echo "install-deps: '$purpose': expected demo, packages, build or test" >&2; exit 2 ;;
esac
if [[ -n $list ]]; then
  printf '%s\n' "${wanted[@]}"
  exit 0
fi

missing=()
for package in "${wanted[@]}"; do
  [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true) == installed ]] || missing+=("$package")
done
if [[ ${#missing[@]} -eq 0 ]]; then
  echo "install-deps: everything for '$purpose' is there"
  exit 0
fi
as_root=()
if [[ $(id -u) -ne 0 ]]; then
  command -v sudo >/dev/null || { echo "install-deps: run this as root, or install sudo" >&2; exit 2; }
  as_root=(sudo)
fi
echo "install-deps: installing for '$purpose': ${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
failed() {
  cat "$log" >&2
  echo "install-deps: apt-get $1 failed, see above" >&2
  exit 1
}
# Of thousands of lines people see the count and each tenth.
progress='/newly installed/ { print "install-deps: " $0; of = $1 + $3 }
          /^Setting up/ && of && int(++done * 10 / of) > tenth {
            tenth = int(done * 10 / of); print "install-deps: " done " of " of " packages set up" }
          { fflush() }'
"${as_root[@]}" apt-get update -q >"$log" 2>&1 || failed update
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}" 2>&1 |
  tee "$log" | awk "$progress" || failed install
