// SPDX-License-Identifier: Apache-2.0
// What a service owes its system: real-time settings, signals, and word to systemd that it lives.
#pragma once

#include <string>

#include "platform/core/time.h"
#include "platform/sbc/robot_file.h"

namespace touchline::sbc {

/// Locks memory, sets scheduler and core. What the system refuses is no failure: one line for each goes to the log.
std::string apply_realtime(const RealtimeConfig& config);

/// SIGTERM and SIGINT ask to end, SIGHUP to read the file again; SIGPIPE and SIGXFSZ are
/// ignored. One object at a time.
class Signals {
 public:
  Signals();
  ~Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;
  [[nodiscard]] static bool end_asked();
  /// True once for each SIGHUP.
  static bool reload_asked();
};

/// systemd's notification socket ($NOTIFY_SOCKET); does nothing where there is none.
class ServiceNotifier {
 public:
  ServiceNotifier();
  ~ServiceNotifier();
  ServiceNotifier(const ServiceNotifier&) = delete;
  ServiceNotifier& operator=(const ServiceNotifier&) = delete;
  void ready() { send("READY=1\n"); }
  void stopping() { send("STOPPING=1\n"); }
  /// Feeds the watchdog, three times in its period at the most. Call it every turn.
  void alive(MonotonicNs now);

 private:
  void send(const char* text);
  int descriptor_ = -1;
  MonotonicNs period_ = 0;  // between two signs of life; 0: no watchdog
  MonotonicNs last_ = 0;
};

}  // namespace touchline::sbc
