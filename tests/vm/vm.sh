#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Hardware in the loop without hardware: boots Debian's own kernel in QEMU with vivid, uhid and joined serial ports, and runs
# every backend, the whole robot and the table of faults in it. The outcome is the marker in the guest's log; without it
# nothing has passed.
#   vm.sh [BUILD [ARCH]]     ARCH amd64 (default) or arm64; status 77: skipped, and why
# On amd64 the guest runs the host's build on the host's file system, read-only. On arm64 the programs are cross-compiled,
# and run on a folder of Debian's arm64 packages.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=$(realpath -m "${1:-build}")
architecture=${2:-amd64}
seconds=${VM_WALK_SECONDS:-60}  # VM_PARTS=backends,robot,faults: some of them only
. platform/sbc/foreign_apt.sh
skip() { echo "skipped: $1"; exit 77; }
work=$build/vm
tools=(busybox cpio depmod dpkg-deb apt-get)
case $architecture in
  amd64)
    machine=(qemu-system-x86_64 -M pc -smp 2)
    console=ttyS0
    serial_ports=(/dev/ttyS1 /dev/ttyS2)
    limit=600 ;;
  arm64)
    work=$build/vm-arm64
    machine=(qemu-system-aarch64 -M virt,gic-version=2 -cpu cortex-a72 -smp 2)
    console=ttyAMA0
    serial_ports=(/dev/ttyS0 /dev/ttyS1)
    limit=2400
    tools+=(aarch64-linux-gnu-g++) ;;
  *) echo "vm.sh: unknown architecture '$architecture' (amd64, arm64)" >&2; exit 2 ;;
esac
for tool in "${machine[0]}" "${tools[@]}"; do
  command -v "$tool" >/dev/null ||
    skip "no $tool (Debian: qemu-system-x86 or qemu-system-arm, busybox-static cpio kmod; g++-aarch64-linux-gnu for arm64)"
done
[ "$(dpkg --print-architecture)" = amd64 ] || skip "this script is made for an amd64 host"
mkdir -p "$work/out"
socket=$(mktemp -d)
trap 'rm -rf "$socket"; foreign_apt_end' EXIT

# Debian's kernel package, unpacked and not installed. The one in use is kept.
if [ "$architecture" = amd64 ]; then
  package=$(apt-cache depends linux-image-amd64 2>/dev/null | awk '/Depends: linux-image/ {print $2; exit}')
  get_kernel() {
    (cd "$work" && rm -f ./linux-image-*.deb && apt-get download "$package" >/dev/null 2>&1 && dpkg-deb -x "$package"_*.deb kernel)
  }
elif [ -s "$work/kernel/package" ]; then
  package=$(cat "$work/kernel/package")
else
  foreign_apt_start arm64 >/dev/null 2>&1 || skip "Debian's list of arm64 packages cannot be had"
  package=$(foreign_apt_depends linux-image-arm64 linux-image)
  get_kernel() { foreign_apt_get "$work/kernel" "$package" >/dev/null 2>&1; }
fi
[ -n "$package" ] || skip "apt knows no kernel package; run apt-get update"
version=${package#linux-image-}
if [ ! -f "$work/kernel/boot/vmlinuz-$version" ]; then
  rm -rf "$work/kernel"
  get_kernel || skip "the kernel package cannot be downloaded"
  rm -f "$work"/linux-image-*.deb
  depmod -b "$work/kernel" "$version"
  echo "$package" >"$work/kernel/package"
fi

launcher=()
command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_C_COMPILER_LAUNCHER=ccache)

# What the guest runs, its root and its busybox.
share=$work/share
mkdir -p "$share"
cmake --build "$build" --target make_walk >/dev/null
if [ "$architecture" = amd64 ]; then
  programs=$build root=/ busybox=$(command -v busybox) guest_share=$share keep=$work
else
  root=$work/root guest_share=/share keep=/share
  bash platform/sbc/sysroot.sh arm64 "$root" libc6 libgcc-s1 libstdc++6 libjpeg62-turbo libpng16-16 zlib1g libtomlplusplus3 \
    libv4l-0 libv4lconvert0 libhidapi-hidraw0 libudev1 libgpiod2 busybox-static || skip "no arm64 packages for the guest"
  bash platform/sbc/sysroot.sh arm64 "$work/sysroot" || skip "no arm64 packages to link with"
  busybox=$root/bin/busybox
  mkdir -p "$root"/{proc,sys,dev,tmp,share}
  for applet in sh sleep insmod rmmod rm cat ls mkdir; do ln -sf busybox "$root/bin/$applet"; done
  programs=$work/build
  cmake -S . -B "$programs" -G Ninja --toolchain "$PWD/platform/sbc/arm64.cmake" "-DTOUCHLINE_SYSROOT=$work/sysroot" \
    "${launcher[@]}" >"$work/build.log" 2>&1 || { cat "$work/build.log"; exit 1; }
fi
guest_programs=(tests/vm/vm_backends tests/vm/vm_robot tests/vm/vm_faults platform/host/touchline)
cmake --build "$programs" --target "${guest_programs[@]##*/}" >"$work/build.log" 2>&1 || { tail -30 "$work/build.log"; exit 1; }
if [ ! "$share/walk-$seconds" -nt "$build/tests/vm/make_walk" ]; then
  rm -f "$share"/walk*
  "$build/tests/vm/make_walk" "$share" "$seconds"
  touch "$share/walk-$seconds"
fi
cp tests/vm/guest.sh "${guest_programs[@]/#/$programs/}" "$share/"
[ "$guest_share" = "$share" ] || cp "$share"/* "$root$guest_share/"

# The panel once more, on libgpiod 2 of Debian 13: its library runs on Debian 12, too.
rm -f "$share/vm_backends_gpiod2"
if [ "$architecture" = amd64 ]; then
  gpiod2=$work/gpiod2/usr
  if [ -f "$gpiod2/include/gpiod.h" ] || { foreign_apt_start amd64 trixie >/dev/null 2>&1 &&
    foreign_apt_get "$work/gpiod2" libgpiod-dev libgpiod3 >/dev/null 2>&1; }; then
    { cmake -S . -B "$work/gpiod2-build" -G Ninja "-DGPIOD_INCLUDE_DIR=$gpiod2/include" \
        "-DGPIOD_LIBRARY=$gpiod2/lib/x86_64-linux-gnu/libgpiod.so.3" "${launcher[@]}" &&
      cmake --build "$work/gpiod2-build" --target vm_backends; } >"$work/build.log" 2>&1 || { tail -30 "$work/build.log"; exit 1; }
    cp "$work/gpiod2-build/tests/vm/vm_backends" "$share/vm_backends_gpiod2"
  else
    echo "skipped: the panel on libgpiod 2 (Debian 13's packages cannot be had)"
  fi
fi

# The initramfs: busybox, and the modules in the order of their dependencies.
tree=$work/initramfs
rm -rf "$tree"
mkdir -p "$tree"/{bin,mods}
cp "$busybox" "$tree/bin/busybox"
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

# The console, and two serial ports joined to each other: the PC has them, the Arm board gets PCI cards.
ports=(-serial stdio -chardev "socket,id=a0,path=$socket/a,server=on,wait=off" -chardev "socket,id=a1,path=$socket/a")
if [ "$architecture" = amd64 ]; then
  ports+=(-serial chardev:a0 -serial chardev:a1)
else
  ports+=(-device pci-serial,chardev=a0 -device pci-serial,chardev=a1)
fi
timeout -k 5 $limit "${machine[@]}" -accel tcg -m 512 -nodefaults -display none -no-reboot \
  -kernel "$work/kernel/boot/vmlinuz-$version" -initrd "$work/initramfs.gz" \
  -append "console=$console quiet panic=-1 share=$guest_share keep=$keep gait=${serial_ports[0]} robot=${serial_ports[1]} parts=${VM_PARTS:-backends,robot,faults} limit=$((limit - 100))" \
  "${ports[@]}" \
  -virtfs "local,path=$root,mount_tag=host,security_model=none,readonly=on,multidevs=remap" \
  -virtfs "local,path=$work/out,mount_tag=out,security_model=none" \
  </dev/null 2>&1 | tr -d '\r' >"$work/guest.log" || true
head -20 "$work/out/log" 2>/dev/null || true
grep -aE '^(PASS|FAIL|robot:|loop:|imu:|gait:|gpiod|module)' "$work/guest.log" || true
if grep -aq '^TOUCHLINE-VM-EXIT:0$' "$work/guest.log"; then
  echo "vmtest: passed on $architecture, kernel $version ($(grep -ac '^PASS' "$work/guest.log") checks)"
else
  echo "vmtest: FAILED on $architecture; the guest's log is $work/guest.log"
  tail -5 "$work/guest.log"
  exit 1
fi
