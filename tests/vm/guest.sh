#!/bin/sh
# Runs inside the virtual machine, in a chroot on the root folder: guest.sh SHARE. The exit status is the outcome.
share=$1
status=0
export PATH=/usr/sbin:/usr/bin:/sbin:/bin
backend() { "$share/vm_backends" "$1" || { echo "FAIL group $1"; status=1; }; }
reload_vivid() { rmmod vivid; insmod /tmp/mods/vivid.ko $VIVID || echo "FAIL vivid does not load again"; }
part() { case ,$PARTS, in *,$1,*) return 0 ;; esac; return 1; }
if part backends; then
  backend imu
  backend gait
  backend panel
  if [ -x "$share/vm_backends_gpiod2" ]; then
    echo "gpiod: the panel once more, on libgpiod 2"
    "$share/vm_backends_gpiod2" panel || { echo "FAIL group panel on libgpiod 2"; status=1; }
  fi
  backend camera
  reload_vivid
  backend camera-back
  backend loop
  reload_vivid
fi
if part robot; then
  rm -f /tmp/ready
  "$share/vm_robot" "$share" /tmp/out/poses.jsonl /tmp/ready &
  director=$!
  tries=0
  until [ -e /tmp/ready ] || [ $tries -ge 300 ]; do sleep 0.1; tries=$((tries + 1)); done
  "$share/touchline" run "$share/robot.toml" >/tmp/out/poses.jsonl 2>/tmp/out/log &
  daemon=$!
  wait $director || status=1
  kill -TERM $daemon
  if wait $daemon; then echo "PASS daemon: SIGTERM ends it with status 0"; else echo "FAIL daemon"; status=1; fi
fi
if part faults; then "$share/vm_faults" "$share" || status=1; fi
exit $status
