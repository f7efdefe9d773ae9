// SPDX-License-Identifier: Apache-2.0
#include "platform/sbc/service.h"

#include <sched.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

namespace touchline::sbc {
namespace {

volatile std::sig_atomic_t end_signal = 0;
volatile std::sig_atomic_t reload_signal = 0;

void on_end(int) { end_signal = 1; }
void on_reload(int) { reload_signal = 1; }

void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;  // no SA_RESTART: waits end early
  sigaction(signal, &action, nullptr);
}

/// The stack grows page by page; a page that is touched first in the loop would be a fault in the loop.
void touch_stack() {
  constexpr std::size_t bytes = 512U * 1024U;
  char pages[bytes];
  volatile char* page = pages;
  for (std::size_t i = 0; i < bytes; i += 4096) page[i] = 0;
}

std::string refusal(const char* what, const char* remedy) {
  return std::string("touchline: ") + what + ": " + std::strerror(errno) + "; " + remedy + "\n";
}

}  // namespace

std::string apply_realtime(const RealtimeConfig& config) {
  std::string problems;
  if (config.lock_memory) {
    touch_stack();
    if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
      problems += refusal("memory is not locked", "raise LimitMEMLOCK, or set realtime.lock_memory = false");
    }
  }
  if (config.priority > 0) {
    sched_param parameters{};
    parameters.sched_priority = config.priority;
    if (sched_setscheduler(0, SCHED_FIFO, &parameters) != 0) {
      problems += refusal("SCHED_FIFO is refused", "raise LimitRTPRIO, or set realtime.priority = 0");
    }
  }
  if (config.cpu >= 0) {
    cpu_set_t cores;
    CPU_ZERO(&cores);
    CPU_SET(static_cast<std::size_t>(config.cpu), &cores);
    if (sched_setaffinity(0, sizeof cores, &cores) != 0) {
      problems += refusal("the core cannot be chosen", "set realtime.cpu to a core that there is, or to -1");
    }
  }
  return problems;
}

Signals::Signals() {
  end_signal = 0;
  reload_signal = 0;
  handle(SIGTERM, on_end);
  handle(SIGINT, on_end);
  handle(SIGHUP, on_reload);
  handle(SIGPIPE, SIG_IGN);
  handle(SIGXFSZ, SIG_IGN);  // a file as long as it may be: EFBIG instead
}
Signals::~Signals() {
  for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGPIPE, SIGXFSZ}) handle(signal, SIG_DFL);
}
bool Signals::end_asked() { return end_signal != 0; }
bool Signals::reload_asked() {
  const bool asked = reload_signal != 0;
  if (asked) reload_signal = 0;
  return asked;
}

ServiceNotifier::ServiceNotifier() {
  const char* path = std::getenv("NOTIFY_SOCKET");
  sockaddr_un address{};
  if (path == nullptr || (path[0] != '/' && path[0] != '@') || std::strlen(path) >= sizeof address.sun_path) return;
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path, std::strlen(path));
  if (path[0] == '@') address.sun_path[0] = '\0';  // an abstract socket
  descriptor_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + std::strlen(path));
  if (descriptor_ >= 0 && ::connect(descriptor_, reinterpret_cast<const sockaddr*>(&address), size) != 0) {
    ::close(descriptor_);
    descriptor_ = -1;
  }
  const char* watchdog = std::getenv("WATCHDOG_USEC");
  if (watchdog != nullptr) period_ = std::strtoll(watchdog, nullptr, 10) * 1000 / 3;
}

ServiceNotifier::~ServiceNotifier() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void ServiceNotifier::alive(MonotonicNs now) {
  if (period_ <= 0 || now - last_ < period_) return;
  last_ = now;
  send("WATCHDOG=1\n");
}

void ServiceNotifier::send(const char* text) {
  if (descriptor_ >= 0) (void)!::send(descriptor_, text, std::strlen(text), MSG_NOSIGNAL);
}

}  // namespace touchline::sbc
