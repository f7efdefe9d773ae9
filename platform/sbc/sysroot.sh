#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Unpacks the Debian packages of another architecture that host tools and backends link, into a folder of their own: needs no
# root, and leaves the system's packages and its list of architectures alone.
#   sysroot.sh ARCHITECTURE FOLDER [PACKAGE...]     e.g. sysroot.sh arm64 build/sysroot-arm64
# Status 3 when the packages cannot be had (no network, no Debian).
set -euo pipefail
[ $# -ge 2 ] || { echo "usage: $0 ARCHITECTURE FOLDER [PACKAGE...]" >&2; exit 2; }
. "$(dirname "$0")/foreign_apt.sh"
architecture=$1
mkdir -p "$2"
folder=$(cd "$2" && pwd)
shift 2
packages=(zlib1g-dev zlib1g libpng-dev libpng16-16 libjpeg62-turbo-dev libjpeg62-turbo libtomlplusplus-dev libtomlplusplus3
          libv4l-dev libv4l-0 libv4lconvert0 libhidapi-dev libhidapi-hidraw0 libudev1 libgpiod-dev libgpiod2)
[ $# -eq 0 ] || packages=("$@")
stamp="$folder/usr/.touchline-packages"
[ "$(cat "$stamp" 2>/dev/null || true)" = "${packages[*]}" ] && exit 0

trap foreign_apt_end EXIT
if ! foreign_apt_start "$architecture" || ! foreign_apt_get "$folder" "${packages[@]}"; then
  echo "sysroot.sh: Debian's $architecture packages could not be downloaded: ${packages[*]}" >&2
  exit 3
fi
echo "${packages[*]}" >"$stamp"
