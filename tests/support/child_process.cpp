// SPDX-License-Identifier: Apache-2.0
#include "tests/support/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>

namespace touchline::test {
namespace {

using Clock = std::chrono::steady_clock;

int left(Clock::time_point end) {
  const auto rest = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
  return static_cast<int>(std::max<decltype(rest)>(rest, 0));
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command, int out) {
  int output[2] = {-1, -1}, log[2] = {-1, -1};
  if ((out < 0 && ::pipe2(output, O_CLOEXEC) != 0) || ::pipe2(log, O_CLOEXEC) != 0) return;
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  pid_ = ::fork();
  if (pid_ == 0) {
    ::dup2(out < 0 ? output[1] : out, STDOUT_FILENO);
    ::dup2(log[1], STDERR_FILENO);
    ::execv(words[0], words.data());
    ::_exit(127);
  }
  if (out < 0) ::close(output[1]);
  ::close(log[1]);
  pipes_[0] = output[0];
  pipes_[1] = log[0];
  for (const int pipe : pipes_) {
    if (pipe >= 0) ::fcntl(pipe, F_SETFL, O_NONBLOCK);
  }
  if (pid_ > 0) process_ = static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0));
}

ChildProcess::~ChildProcess() {
  if (pid_ > 0 && !status_) {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  for (const int file : {pipes_[0], pipes_[1], process_}) {
    if (file >= 0) ::close(file);
  }
}

void ChildProcess::send(int signal) const {
  if (pid_ > 0 && !status_) ::kill(pid_, signal);
}

bool ChildProcess::collect(int milliseconds) {
  pollfd files[] = {{pipes_[0], POLLIN, 0}, {pipes_[1], POLLIN, 0}, {status_ ? -1 : process_, POLLIN, 0}};
  if (::poll(files, 3, milliseconds) <= 0) return false;
  bool any = false;
  for (int i = 0; i < 2; ++i) {
    if (files[i].revents == 0) continue;
    char bytes[4096];
    ssize_t size = 0;
    while ((size = ::read(pipes_[i], bytes, sizeof bytes)) > 0) {
      text_[i].append(bytes, static_cast<std::size_t>(size));
      any = true;
    }
    if (size == 0) {  // nobody writes any more
      ::close(pipes_[i]);
      pipes_[i] = -1;
    }
  }
  if (files[2].revents != 0) {
    int status = 0;
    if (::waitpid(pid_, &status, WNOHANG) == pid_) {
      status_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    }
    any = true;
  }
  return any;
}

template <typename Condition>
bool ChildProcess::wait_until(const Condition& condition, int milliseconds) {
  const auto end = Clock::now() + std::chrono::milliseconds(milliseconds);
  while (!condition()) {
    if (left(end) == 0) return false;
    collect(left(end));
  }
  return true;
}

bool ChildProcess::wait_for_log(const std::string& text, int milliseconds) {
  return wait_until([&] { return text_[1].find(text) != std::string::npos; }, milliseconds);
}

bool ChildProcess::wait_for_lines(std::size_t lines, int milliseconds) {
  const auto whole = [&] { return std::count(text_[0].begin(), text_[0].end(), '\n'); };
  return wait_until([&] { return static_cast<std::size_t>(whole()) >= lines; }, milliseconds);
}

std::optional<int> ChildProcess::wait_for_end(int milliseconds) {
  (void)wait_until([&] { return status_.has_value(); }, milliseconds);
  return status_;
}

std::optional<std::string> ChildProcess::take_line() {
  const std::size_t end = text_[0].find('\n');
  if (end == std::string::npos) return {};
  std::string line = text_[0].substr(0, end);
  text_[0].erase(0, end + 1);
  return line;
}

}  // namespace touchline::test
