#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the Debian packages that a make target misses: as root, or by sudo where it asks no password. Else it prints
# the exact command and fails. Says nothing and touches nothing when all is there.
#   need.sh GROUP...    groups: build test check backends vm bench profile cross bare
set -euo pipefail

packages=()
for group in "$@"; do
  case $group in
    build) packages+=(make cmake g++ libeigen3-dev libtomlplusplus-dev nlohmann-json3-dev libcli11-dev libstb-dev
                      libpng-dev libjpeg-dev) ;;
    test) packages+=(binutils doctest-dev pkgconf) ;;
    check) packages+=(clang clang-format clang-tidy ninja-build ccache) ;;
    vm) packages+=(qemu-system-x86 busybox-static cpio kmod) ;;
    backends) packages+=(libv4l-dev libgpiod-dev libhidapi-dev) ;;
    bench) packages+=(libbenchmark-dev libopencv-dev libopencv-contrib-dev) ;;
    profile) packages+=(valgrind) ;;
    cross) packages+=(g++-aarch64-linux-gnu g++-arm-linux-gnueabihf qemu-user-static) ;;
    bare) packages+=(gcc-arm-none-eabi libstdc++-arm-none-eabi-newlib qemu-system-arm) ;;
    *) echo "need.sh: unknown group '$group' (build test check backends vm bench profile cross bare)" >&2; exit 2 ;;
  esac
done

if ! command -v dpkg-query >/dev/null; then
  echo "note: not a Debian system; these Debian packages have to be there under their local names: ${packages[*]}" >&2
  exit 0
fi

missing=()
for package in "${packages[@]}"; do
  state=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$state" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
    as_root=(sudo -n)
  else
    echo "Some packages are missing. Please run this, then try again:" >&2
    echo "  sudo apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
  fi
fi
echo "Installing what is missing: ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
install=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 install -qq -y --no-install-recommends "${missing[@]}")
"${install[@]}" >/dev/null || { "${as_root[@]}" apt-get update -qq && "${install[@]}" >/dev/null; } || {
  echo "The packages could not be installed. Please look at: sudo apt-get install ${missing[*]}" >&2
  exit 1
}
