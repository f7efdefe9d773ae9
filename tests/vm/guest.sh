#!/bin/bash
# Runs inside the virtual machine, in a chroot on the host's file system: guest.sh SHARE. The exit status is the outcome.
share=$1
status=0
export PATH=/usr/sbin:/usr/bin:/sbin:/bin
backend() { "$share/vm_backends" "$1" || { echo "FAIL group $1"; status=1; }; }
reload_vivid() { rmmod vivid; insmod /tmp/mods/vivid.ko $VIVID || echo "FAIL vivid does not load again"; }
backend imu
backend gait
backend panel
backend camera
reload_vivid
backend camera-back
backend loop
reload_vivid
if [ -f "$share/walk.txt" ]; then
  rm -f /tmp/ready
  "$share/vm_robot" "$share" /tmp/out/poses.jsonl /tmp/ready &
  director=$!
  for _ in $(seq 100); do [ -e /tmp/ready ] && break; sleep 0.1; done
  "$share/touchline" run "$share/robot.toml" >/tmp/out/poses.jsonl 2>/tmp/out/log &
  daemon=$!
  wait $director || status=1
  before=$(date +%s%N)
  kill -TERM $daemon
  wait $daemon && echo "PASS daemon: SIGTERM ends it with status 0, after $((($(date +%s%N) - before) / 1000000)) ms" || { echo "FAIL daemon"; status=1; }
fi
exit $status
