#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# The firmware's gait header on a Cortex-M7: no warning, no foreign symbol, less than 1 KiB of code. Status 77: skipped.
# usage: gait_header_size.sh SOURCE_DIR BUILD_DIR
set -e
cc=arm-none-eabi-gcc
command -v $cc >/dev/null || { echo "skipped: no $cc (Debian: gcc-arm-none-eabi)"; exit 77; }
object="$2/gait_header_m7.o"
for level in -Os -O2; do
  $cc -std=c99 -mcpu=cortex-m7 -mfpu=fpv5-d16 -mfloat-abi=hard -mthumb $level -ffreestanding -Wall -Wextra -Wpedantic \
    -Wconversion -Wsign-conversion -Wshadow -Wdouble-promotion -Werror -I"$1" -c "$1/tests/hal/gait_header.c" -o "$object"
  foreign=$(arm-none-eabi-nm --undefined-only "$object" | awk '{print $2}' | grep -vE '^(memcpy|memset)$' || true)
  [ -z "$foreign" ] || { echo "the gait header needs $foreign"; exit 1; }
  bytes=$(arm-none-eabi-size "$object" | awk 'NR==2 {print $1 + $2 + $3}')
  echo "gait header at $level: $bytes bytes"
  [ "$bytes" -lt 1024 ] || { echo "the gait header takes 1 KiB or more"; exit 1; }
done
