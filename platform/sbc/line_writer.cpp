// SPDX-License-Identifier: Apache-2.0
#include "platform/sbc/line_writer.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>

namespace touchline::sbc {
namespace {

/// The same terminal or pipe by an open file description of its own: "do not wait" set there does not reach the shell,
/// which shares the first one.
int open_anew(int descriptor) {
  std::array<char, 32> path{};
  std::snprintf(path.data(), path.size(), "/proc/self/fd/%d", descriptor);
  return ::open(path.data(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
}

}  // namespace

LineWriter::LineWriter(int descriptor) : descriptor_(descriptor) {
  struct stat what {};
  if (descriptor < 0 || ::fstat(descriptor, &what) != 0) return;
  is_socket_ = S_ISSOCK(what.st_mode);
  if (!S_ISFIFO(what.st_mode) && ::isatty(descriptor) == 0) return;  // files do not make a writer wait for a reader
  const int anew = open_anew(descriptor);
  own_ = anew >= 0;
  if (own_) {
    descriptor_ = anew;
  } else if (S_ISFIFO(what.st_mode)) {
    ask_first_ = true;
  } else {
    use_terminal(descriptor);
  }
}

/// Another user's terminal, after su: only the shared description is left.
void LineWriter::use_terminal(int descriptor) {
  const int flags = ::fcntl(descriptor, F_GETFL);
  was_blocking_ = flags >= 0 && (flags & O_NONBLOCK) == 0 && ::fcntl(descriptor, F_SETFL, flags | O_NONBLOCK) == 0;
}

LineWriter::~LineWriter() {
  (void)finish_last();
  if (was_blocking_) {
    const int flags = ::fcntl(descriptor_, F_GETFL);
    if (flags >= 0) ::fcntl(descriptor_, F_SETFL, flags & ~O_NONBLOCK);
  }
  if (own_) ::close(descriptor_);
}

long LineWriter::send(const char* bytes, std::size_t size) const {
  if (is_socket_) return ::send(descriptor_, bytes, size, MSG_DONTWAIT | MSG_NOSIGNAL);
  pollfd ready{descriptor_, POLLOUT, 0};
  if (ask_first_ && ::poll(&ready, 1, 0) == 0) {
    errno = EAGAIN;
    return -1;
  }
  return ::write(descriptor_, bytes, size);
}

/// 0 when nothing of the last line is left.
int LineWriter::finish_last() {
  if (rest_size_ == 0 || gone_ != 0) return gone_;
  const long written = send(rest_.data(), rest_size_);
  if (written < 0) return errno;
  std::copy(rest_.begin() + written, rest_.begin() + static_cast<long>(rest_size_), rest_.begin());
  rest_size_ -= static_cast<std::size_t>(written);
  if (rest_size_ == 0) return 0;
  return own_ || is_socket_ || was_blocking_ ? EAGAIN : ENOSPC;
}

int LineWriter::write(std::string_view line) {
  if (descriptor_ < 0) return 0;
  if (line.size() > longest_line) return EMSGSIZE;
  int error = finish_last();
  long written = 0;
  if (error == 0) {
    written = send(line.data(), line.size());
    if (written < 0) error = errno;
  }
  if (error == EPIPE || error == EBADF) gone_ = error;
  if (error != 0) return error;
  if (written == 0) return ENOSPC;
  const std::string_view rest = line.substr(static_cast<std::size_t>(written));
  std::copy(rest.begin(), rest.end(), rest_.begin());
  rest_size_ = rest.size();
  return 0;
}

}  // namespace touchline::sbc
