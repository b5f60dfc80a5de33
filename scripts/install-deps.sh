#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what building, testing and the demo need on Debian 12, as far as it is missing. As root, or with sudo.
set -euo pipefail

build=(
  g++ cmake ninja-build ccache pkg-config git python3
  khronos-api                        # gl.xml, from which much of the code is generated
  libglvnd-dev libgl-dev libegl-dev libglx-dev
  libx11-dev libx11-xcb-dev libxcb1-dev libxrandr-dev libxss-dev
  libboost1.81-dev libprotobuf-dev protobuf-compiler libprotozero-dev
  libexpected-dev libspdlog-dev libfmt-dev libtomlplusplus-dev libcli11-dev nlohmann-json3-dev
  libsdl2-dev                        # wallview's window
  libopencv-core-dev libopencv-imgproc-dev libopencv-imgcodecs-dev libsystemd-dev prometheus-cpp-dev
  libgtest-dev libgmock-dev libbenchmark-dev
  liblz4-dev libzstd-dev             # frame codecs
  libssl-dev                         # content hashes
  libavcodec-dev libavutil-dev       # only benchmarks: FFmpeg's codecs beside ours
)
run=(
  libgl1 libegl1 libgl1-mesa-dri libglx-mesa0 libegl-mesa0 libosmesa6
  xvfb xauth mesa-utils xscreensaver-gl procps
)
test=(
  clang-16 libclang-rt-16-dev        # fuzzers
  xscreensaver-gl-extra rss-glx glmark2-x11 apitrace apitrace-tracers
  piglit                             # the conformance tests
  ffmpeg                             # decodes what our codecs write, and the other way round
  x11-utils x11-xserver-utils        # xprop, xwininfo; xrandr: monitors of a display that has none
  xterm fonts-dejavu-core            # the text desktop of the codec benchmark
  libglu1-mesa-dev python3-numpy python3-opencv python3-jsonschema python3-yaml python3-prometheus-client curl systemd
  chromium                           # the status page in a real browser
)
# Node.js may come from elsewhere, with npm in it; Debian's npm does not go with that.
command -v node >/dev/null || test+=(nodejs)
command -v npm >/dev/null || test+=(npm)

missing=()
for package in "${build[@]}" "${run[@]}" "${test[@]}"; do
  [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true) == installed ]] || missing+=("$package")
done
if [[ ${#missing[@]} -eq 0 ]]; then
  echo "install-deps: everything is there"
  exit 0
fi
echo "install-deps: installing ${#missing[@]} packages: ${missing[*]}"
as_root=()
if [[ $(id -u) -ne 0 ]]; then
  command -v sudo >/dev/null || { echo "install-deps: run this as root, or install sudo" >&2; exit 2; }
  as_root=(sudo)
fi
"${as_root[@]}" apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
