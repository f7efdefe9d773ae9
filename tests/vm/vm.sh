#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Hardware in the loop without hardware: boots Debian's own kernel in QEMU with vivid, uhid and joined serial ports, and runs
# every backend and the whole robot in it. The outcome is the marker in the guest's log; without it nothing has passed.
#   vm.sh [BUILD]     status 77: skipped, and why
set -euo pipefail
cd "$(dirname "$0")/../.."
build=$(realpath -m "${1:-build}")
work=$build/vm
seconds=${VM_WALK_SECONDS:-60}
skip() { echo "skipped: $1"; exit 77; }
for tool in qemu-system-x86_64 busybox cpio depmod dpkg-deb apt-get; do
  command -v $tool >/dev/null || skip "no $tool (Debian: qemu-system-x86 busybox-static cpio kmod)"
done
[ "$(dpkg --print-architecture)" = amd64 ] || skip "this script boots the amd64 kernel of Debian"
mkdir -p "$work/out"

# Debian's kernel package, unpacked and not installed. The one in use is kept.
package=$(apt-cache depends linux-image-amd64 2>/dev/null | awk '/Depends: linux-image/ {print $2; exit}')
[ -n "$package" ] || skip "apt knows no kernel package; run apt-get update"
version=${package#linux-image-}
if [ ! -f "$work/kernel/boot/vmlinuz-$version" ]; then
  rm -rf "$work/kernel"
  (cd "$work" && rm -f ./linux-image-*.deb && apt-get download "$package" >/dev/null 2>&1) || skip "the kernel package cannot be downloaded"
  dpkg-deb -x "$work/$package"_*.deb "$work/kernel"
  rm -f "$work"/linux-image-*.deb
  depmod -b "$work/kernel" "$version"
fi

# The initramfs: busybox, and the modules in the order of their dependencies.
tree=$work/initramfs
rm -rf "$tree"
mkdir -p "$tree"/{bin,mods}
cp "$(command -v busybox)" "$tree/bin/busybox"
ln -s busybox "$tree/bin/sh"
install -m 755 tests/vm/init "$tree/init"
for module in virtio_pci 9pnet_virtio 9p vivid uhid usbhid hid-generic hid-cp2112; do
  modprobe -d "$work/kernel" -S "$version" --show-depends $module | awk '$1 == "insmod" {print $2}' | while read -r path; do
    name=$(basename "$path")
    [ -e "$tree/mods/$name" ] && continue
    cp "$path" "$tree/mods/"
    echo "$name" >>"$tree/mods/order"
  done
done
(cd "$tree" && find . | cpio -o -H newc -R 0:0 2>/dev/null | gzip -1) >"$work/initramfs.gz"

# What the guest runs, from the build folder; the host's file system is its own, read-only.
cmake --build "$build" --target vm_backends vm_robot make_walk touchline >/dev/null
share=$work/share
mkdir -p "$share"
if [ ! -f "$share/walk-$seconds" ]; then
  rm -f "$share"/walk*
  "$build/tests/vm/make_walk" "$share" "$seconds"
  touch "$share/walk-$seconds"
fi
cp tests/vm/guest.sh "$build/tests/vm/vm_backends" "$build/tests/vm/vm_robot" "$build/platform/host/touchline" "$share/"

socket=$(mktemp -d)
trap 'rm -rf "$socket"' EXIT
timeout -k 5 420 qemu-system-x86_64 -M pc -accel tcg -smp 2 -m 512 -nodefaults -display none -no-reboot \
  -kernel "$work/kernel/boot/vmlinuz-$version" -initrd "$work/initramfs.gz" \
  -append "console=ttyS0 quiet panic=-1 share=$share" -serial stdio \
  -chardev "socket,id=a0,path=$socket/a,server=on,wait=off" -chardev "socket,id=a1,path=$socket/a" \
  -serial chardev:a0 -serial chardev:a1 \
  -virtfs local,path=/,mount_tag=host,security_model=none,readonly=on,multidevs=remap \
  -virtfs "local,path=$work/out,mount_tag=out,security_model=none" \
  </dev/null 2>&1 | tr -d '\r' >"$work/guest.log" || true
head -20 "$work/out/log" 2>/dev/null || true
grep -aE '^(PASS|FAIL|robot:|loop:|imu:|gait:|module)' "$work/guest.log" || true
if grep -aq '^TOUCHLINE-VM-EXIT:0$' "$work/guest.log"; then
  echo "vmtest: passed ($(grep -ac '^PASS' "$work/guest.log") checks)"
else
  echo "vmtest: FAILED; the guest's log is $work/guest.log"
  tail -5 "$work/guest.log"
  exit 1
fi
