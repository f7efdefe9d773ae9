#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Dependencies point one way: platform/core <- vision <- loc, platform/core <- hal. Every #include line of the tree is
# held against what its room may use. Also: vendor headers only in hal/linux, no heap, host or clock headers in the
# core, and every source says its licence.
#   layering.sh ROOT
set -euo pipefail
export LC_ALL=C
cd "${1:?usage: layering.sh ROOT}"

# Headers of the standard library that neither allocate, throw, print nor ask for the time. <cmath> is out: its
# functions differ in the last bit from one C library to the next (platform/core/elementary.h has ours).
std_allowed='algorithm|array|atomic|bit|cassert|cfloat|climits|compare|concepts|cstddef|cstdint|cstring|initializer_list|iterator|limits|numeric|optional|span|string_view|tuple|type_traits|utility|version'
vendor='libv4l|linux/videodev2|linux/hidraw|linux/input|linux/gpio|gpiod|hidapi|hidapi/hidapi|systemd/'

failed=0
complain() {
  echo "layering: $1"
  failed=1
}

# rule ROOM ALLOWED_PROJECT ALLOWED_OTHER EXCLUDED_PATHS: extended regular expressions on the included path.
rule() {
  local room=$1 project=$2 other=$3 excluded=${4:-^$}
  [ -d "$room" ] || return 0
  while IFS=: read -r file line text; do
    [ -n "$file" ] || continue
    [[ $file =~ $excluded ]] && continue
    [[ $text =~ include[[:space:]]*[\"\<]([^\"\>]+) ]] || continue
    local path=${BASH_REMATCH[1]}
    if [[ $text == *\"* ]]; then
      [[ $path =~ ^($project) ]] || complain "$file:$line: $room may include $project but not \"$path\""
    else
      [[ $path =~ ^($other)$ ]] || complain "$file:$line: <$path> has no place in $room"
    fi
  done < <(grep -rnE '^[[:space:]]*#[[:space:]]*include' --include='*.h' --include='*.cpp' --include='*.c' "$room" || true)
}

# Kernels, the loops that they share, and the arithmetic on parts of words are the only files that may name a
# processor's vector instructions.
rule platform/core 'platform/core/' "$std_allowed" '^platform/core/[a-z_]+_loops[.]h$'
rule vision 'platform/core/|vision/' "$std_allowed|Eigen/[A-Za-z]+" '^vision/(image/)?(kernels_[a-z0-9]+[.]cpp|[a-z_]+_(loops|avx2|avx512)[.]h|word_lanes[.]h)$'
rule loc 'platform/core/|vision/|loc/' "$std_allowed|Eigen/[A-Za-z]+" '^loc/(kernels_[a-z0-9]+[.]cpp|[a-z_]+_loops[.]h)$'
# hal: interfaces and codecs are core; backends may use the operating system.
rule hal 'platform/core/|hal/' "$std_allowed" '^hal/(linux|mock|replay|firmware)/'
# The robot's program joins them, on interfaces alone.
rule platform/robot 'platform/core/|vision/|loc/|hal/[a-z_]+\.h|platform/robot/' "$std_allowed"
# What goes into a controller's firmware is C99 and stands alone.
rule hal/firmware '$^' 'stdint\.h'

# The installed headers need no other package.
while IFS= read -r hit; do
  [ -n "$hit" ] && complain "$hit: Eigen belongs in .cpp files, so that users of the headers do not need it"
done < <(grep -rnE '#[[:space:]]*include[[:space:]]*<Eigen' --include='*.h' platform/core vision loc hal || true)

while IFS= read -r hit; do
  [ -n "$hit" ] && complain "$hit: vendor headers belong in hal/linux"
done < <(grep -rnE "#[[:space:]]*include[[:space:]]*[<\"]($vendor)" --include='*.h' --include='*.cpp' --include='*.c' . |
  grep -vE '^\./(hal/linux|tests/hal/linux|tests/vm|tests/support|build[^/]*)/' || true)

while IFS= read -r file; do
  complain "$file: the first line does not say the licence (// SPDX-License-Identifier: Apache-2.0)"
done < <(find platform vision loc hal tests -name '*.h' -o -name '*.cpp' -o -name '*.c' | sort |
  while IFS= read -r file; do head -n 1 "$file" | grep -q 'SPDX-License-Identifier: Apache-2.0' || echo "$file"; done)

[ $failed -eq 0 ] && echo "layering: ok"
exit $failed
