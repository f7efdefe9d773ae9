#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Unpacks the Debian packages of another architecture that host tools and backends link, into a folder of their own: needs no
# root, and leaves the system's packages and its list of architectures alone.
#   sysroot.sh ARCHITECTURE FOLDER     e.g. sysroot.sh arm64 build/sysroot-arm64
# Status 3 when the packages cannot be had (no network, no Debian).
set -euo pipefail
[ $# -eq 2 ] || { echo "usage: $0 ARCHITECTURE FOLDER" >&2; exit 2; }
architecture=$1
mkdir -p "$2"
folder=$(cd "$2" && pwd)
packages=(zlib1g-dev zlib1g libpng-dev libpng16-16 libjpeg62-turbo-dev libjpeg62-turbo libtomlplusplus-dev libtomlplusplus3
          libv4l-dev libv4l-0 libv4lconvert0 libhidapi-dev libhidapi-hidraw0 libudev1 libgpiod-dev libgpiod2)
stamp="$folder/usr/.touchline-packages"
[ "$(cat "$stamp" 2>/dev/null || true)" = "${packages[*]}" ] && exit 0

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
chmod 755 "$work"
mkdir -p "$work"/{state/lists/partial,cache/archives/partial,sources,debs}
: >"$work/status"
release=$(. /etc/os-release && echo "${VERSION_CODENAME:-bookworm}")
cat >"$work/sources/debian.sources" <<END
Types: deb
URIs: http://deb.debian.org/debian
Suites: $release
Components: main
Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg
END
apt=(apt-get -qq -o "Dir::State=$work/state" -o "Dir::State::status=$work/status" -o "Dir::Cache=$work/cache"
     -o Dir::Etc::SourceList=/dev/null -o "Dir::Etc::SourceParts=$work/sources" -o Acquire::Languages=none
     -o "APT::Architecture=$architecture" -o "APT::Architectures::=$architecture" -o APT::Sandbox::User=root)
cd "$work/debs"
if ! command -v apt-get >/dev/null || ! "${apt[@]}" update || ! "${apt[@]}" download "${packages[@]}"; then
  echo "sysroot.sh: Debian's $architecture packages could not be downloaded: ${packages[*]}" >&2
  exit 3
fi
for deb in *.deb; do dpkg-deb -x "$deb" "$folder"; done
echo "${packages[*]}" >"$stamp"
