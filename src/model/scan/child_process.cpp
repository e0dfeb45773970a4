// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scan/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "viscera/math/error.h"

namespace viscera {
namespace {

constexpr size_t kBuffer = 1 << 16, kMostLine = 4096;
constexpr rlim_t kMostCpuSeconds = 900, kMostErrorBytes = 1 << 20;
constexpr int kNoProgram = 127;  ///< exit status of a shell that finds no program

void limit(int what, rlim_t most) {
  const rlimit both{most, most};
  setrlimit(static_cast<__rlimit_resource>(what), &both);
}

/// Turns the child into the program. Nothing may allocate from here on.
[[noreturn]] void become(char* const* arguments, int out, int errors, rlim_t bytes) {
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(errors, STDERR_FILENO);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // sanitizers reserve terabytes of address space
  limit(RLIMIT_AS, bytes);
#else
  (void)bytes;
#endif
  limit(RLIMIT_CPU, kMostCpuSeconds);
  limit(RLIMIT_FSIZE, kMostErrorBytes);
  limit(RLIMIT_CORE, 0);
  execvp(arguments[0], arguments);
  _exit(kNoProgram);
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& arguments, uint64_t bytes, int silence_s, std::string what)
    : what_(std::move(what)), silence_ms_(silence_s * 1000), bytes_(bytes), buffer_(kBuffer) {
  std::vector<char*> pointers;
  for (const std::string& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);
  int ends[2] = {-1, -1};
  errors_ = memfd_create("viscera", MFD_CLOEXEC);
  if (errors_ < 0 || pipe2(ends, O_CLOEXEC) != 0 || (pid_ = fork()) < 0) {
    const std::string why = std::strerror(errno);
    for (const int fd : {errors_, ends[0], ends[1]})
      if (fd >= 0) close(fd);
    throw SceneError(what_ + ": cannot start a process: " + why);
  }
  if (pid_ == 0) become(pointers.data(), ends[1], errors_, bytes);
  close(ends[1]);
  out_ = ends[0];
}

ChildProcess::~ChildProcess() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    ended();
  }
  close(out_);
  close(errors_);
}

int ChildProcess::ended() {
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return status;
}

void ChildProcess::fail() {
  const int status = ended();
  if (WIFSIGNALED(status))
    throw SceneError(what_ + ": the library that reads DICOM crashed on it (" + strsignal(WTERMSIG(status)) +
                     "); accepted: undamaged files that need at most " + std::to_string(bytes_ >> 20) + " MiB");
  if (WIFEXITED(status) && WEXITSTATUS(status) == kNoProgram)
    throw SceneError(
        what_ +
        ": the program viscera-dicom, which reads DICOM, was not found or did not start. It is searched next to "
        "this program, in PATH, and at VISCERA_DICOM; with GDCM installed, `scripts/build --only "
        "viscera-dicom` builds it");
  std::string text(kMostLine, '\0');
  const ssize_t got = pread(errors_, text.data(), text.size(), 0);
  text.resize(static_cast<size_t>(std::max<ssize_t>(got, 0)));
  while (!text.empty() && text.back() == '\n') text.pop_back();
  throw SceneError(text.empty() ? what_ + ": viscera-dicom ended early" : text);
}

size_t ChildProcess::more() {
  pollfd wait{out_, POLLIN, 0};
  int ready = 0;
  while ((ready = poll(&wait, 1, silence_ms_)) < 0 && errno == EINTR) {
  }
  if (ready <= 0)
    throw SceneError(what_ + ": viscera-dicom did not respond for " + std::to_string(silence_ms_ / 1000) +
                     " s, which is the limit");
  ssize_t got = 0;
  while ((got = ::read(out_, buffer_.data(), buffer_.size())) < 0 && errno == EINTR) {
  }
  at_ = 0;
  return held_ = static_cast<size_t>(std::max<ssize_t>(got, 0));
}

void ChildProcess::read(void* to, size_t bytes) {
  auto* next = static_cast<char*>(to);
  while (bytes > 0) {
    if (at_ == held_ && more() == 0) fail();
    const size_t some = std::min(bytes, held_ - at_);
    std::memcpy(next, buffer_.data() + at_, some);
    next += some;
    at_ += some;
    bytes -= some;
  }
}

std::string ChildProcess::line() {
  std::string text;
  for (char c = 0;; text += c) {
    read(&c, 1);
    if (c == '\n') return text;
    if (text.size() >= kMostLine) throw SceneError(what_ + ": viscera-dicom sent a line that is too long");
  }
}

void ChildProcess::finish() {
  while (more() > 0) {
  }
  const pid_t pid = pid_;
  siginfo_t info{};
  if (waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOWAIT) != 0 || info.si_code != CLD_EXITED ||
      info.si_status != 0)
    fail();
  ended();
}

}  // namespace viscera
