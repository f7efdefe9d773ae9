#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the build, moves the install to another place, and builds and runs a user's program there: once by
# find_package, once by pkg-config.
#   install_test.sh BUILD_DIR USER_SOURCE_DIR CMAKE CXX PKG_CONFIG
set -euo pipefail
build=$1 user=$2 cmake=$3 cxx=$4 pkg_config=$5
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT

"$cmake" --install "$build" --prefix "$place/first" >"$place/install.log" || { cat "$place/install.log"; exit 1; }
# The unit names the program where it was installed, wherever that is; DESTDIR is a way station.
unit_names() {  # unit_names UNIT PATH
  [ "$(grep -c "^ExecStart\(Pre\)\?=$2/bin/touchline " "$1")" = 2 ] || { echo "$1 does not name $2/bin/touchline:"; grep ^Exec "$1"; exit 1; }
}
if [ -e "$place/first/bin/touchline" ] && [ -e "$place/first/lib/systemd" ]; then
  unit_names "$place/first/lib/systemd/system/touchline.service" "$place/first"
  DESTDIR="$place/root" "$cmake" --install "$build" --prefix /opt/robot >>"$place/install.log"
  unit_names "$place/root/opt/robot/lib/systemd/system/touchline.service" /opt/robot
fi
mv "$place/first" "$place/prefix"

"$cmake" -S "$user" -B "$place/user" -DCMAKE_PREFIX_PATH="$place/prefix" -DCMAKE_CXX_COMPILER="$cxx" \
  -DCMAKE_BUILD_TYPE=Release >"$place/configure.log" || { cat "$place/configure.log"; exit 1; }
"$cmake" --build "$place/user"
by_cmake=$("$place/user/user")

PKG_CONFIG_PATH=$(dirname "$(find "$place/prefix" -name touchline.pc)")
export PKG_CONFIG_PATH
# shellcheck disable=SC2046  # flags are words
"$cxx" -std=c++20 -O2 "$user/main.cpp" -o "$place/by_pkg_config" $("$pkg_config" --cflags --libs touchline)
by_pkg_config=$("$place/by_pkg_config")

echo "find_package: $by_cmake"
echo "pkg-config:   $by_pkg_config"
[ -n "$by_cmake" ] && [ "$by_cmake" = "$by_pkg_config" ]
