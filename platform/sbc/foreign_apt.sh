# SPDX-License-Identifier: Apache-2.0
# To be sourced: Debian packages of another architecture, or of another release, by an apt of its own. It needs no root, and
# leaves the system's packages, lists and architectures alone.
#   foreign_apt_start ARCHITECTURE [RELEASE]      status 1: no network, or no Debian
#   foreign_apt_get FOLDER PACKAGE...             downloads and unpacks into FOLDER; nothing is installed
#   foreign_apt_depends PACKAGE PREFIX            the first package that PACKAGE depends on whose name starts with PREFIX
#   foreign_apt_end
foreign_apt_start() {
  local release=${2:-$(. /etc/os-release && echo "${VERSION_CODENAME:-bookworm}")}
  command -v apt-get >/dev/null || return 1
  foreign=$(mktemp -d)
  chmod 755 "$foreign"
  mkdir -p "$foreign"/{state/lists/partial,cache/archives/partial,sources}
  : >"$foreign/status"
  cat >"$foreign/sources/debian.sources" <<END
Types: deb
URIs: http://deb.debian.org/debian
Suites: $release
Components: main
Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg
END
  foreign_options=(-o "Dir::State=$foreign/state" -o "Dir::State::status=$foreign/status" -o "Dir::Cache=$foreign/cache"
    -o Dir::Etc::SourceList=/dev/null -o "Dir::Etc::SourceParts=$foreign/sources" -o Acquire::Languages=none
    -o "APT::Architecture=$1" -o "APT::Architectures::=$1" -o APT::Sandbox::User=root)
  apt-get -qq "${foreign_options[@]}" update || { foreign_apt_end; return 1; }
}
foreign_apt_get() {
  local folder=$1 deb
  mkdir -p "$folder" "$foreign/debs"
  (cd "$foreign/debs" && apt-get -qq "${foreign_options[@]}" download "${@:2}") || return 1
  for deb in "$foreign"/debs/*.deb; do dpkg-deb -x "$deb" "$folder" || return 1; done
  rm -rf "$foreign/debs"
}
foreign_apt_depends() { apt-cache "${foreign_options[@]}" depends "$1" | awk -v p="$2" '/Depends:/ && index($2, p) == 1 {print $2; exit}'; }
foreign_apt_end() { [ -z "${foreign:-}" ] || rm -rf "$foreign"; }
