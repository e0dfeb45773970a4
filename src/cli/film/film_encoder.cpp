// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/film/film_encoder.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <utility>
#include <vector>

#include "math/number_text.h"
#include "viscera/math/error.h"

extern char** environ;

namespace viscera::cli {

namespace {

constexpr int kPipe = 1 << 20;      // bytes; Linux gives 64 KiB otherwise, a fraction of an image
constexpr off_t kMessages = 16384;  // bytes of messages that are searched for the last line

/// Makes a write into a pipe without a reader fail with EPIPE in this thread, instead of a signal to the process.
class NoPipeSignal {
 public:
  NoPipeSignal() {
    sigemptyset(&pipe_);
    sigaddset(&pipe_, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  ~NoPipeSignal() {
    const timespec now{};
    if (sigismember(&before_, SIGPIPE) == 0) sigtimedwait(&pipe_, nullptr, &now);
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  NoPipeSignal(const NoPipeSignal&) = delete;
  NoPipeSignal& operator=(const NoPipeSignal&) = delete;

 private:
  sigset_t pipe_, before_;
};

std::vector<std::string> argumentsOf(const FilmFormat& format, const std::string& file) {
  const std::string size = std::to_string(format.width) + "x" + std::to_string(format.height);
  std::vector<std::string> out = {"ffmpeg", "-nostdin", "-hide_banner", "-loglevel", "error", "-xerror", "-y"};
  const auto add = [&](std::initializer_list<const char*> more) { out.insert(out.end(), more.begin(), more.end()); };
  add({"-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", size.c_str()});
  out.insert(out.end(), {"-framerate", exactText(format.rate_hz), "-i", "pipe:0"});
  add({"-vf", "scale=out_color_matrix=bt709", "-pix_fmt", "yuv420p", "-c:v", "libx264", "-crf", "23"});
  add({"-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709"});
  add({"-movflags", "+faststart", "-f", "mp4"});
  out.push_back("file:" + file);
  return out;
}

/// Starts ffmpeg. @param images, messages  its standard input and error   @return 0, or an error number
int start(pid_t& process, const std::vector<std::string>& arguments, int images, int messages) {
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, images, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, messages, STDERR_FILENO);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  const int error = posix_spawn(&process, ffmpegPath().c_str(), &files, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  return error;
}

}  // namespace

std::string ffmpegPath() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "/usr/local/bin:/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string file = (folder.empty() ? "." : folder) + "/ffmpeg";
    struct stat status = {};
    if (stat(file.c_str(), &status) == 0 && S_ISREG(status.st_mode) && access(file.c_str(), X_OK) == 0) return file;
  }
  return "";
}

FilmEncoder::FilmEncoder(const FilmFormat& format, const std::string& file, std::string name)
    : name_(std::move(name)), image_bytes_(size_t{3} * format.width * format.height) {
  int ends[2] = {-1, -1};
  messages_ = memfd_create("viscera film", MFD_CLOEXEC);
  int error = messages_ < 0 || pipe2(ends, O_CLOEXEC) != 0 ? errno : 0;
  if (error == 0) error = start(process_, argumentsOf(format, file), ends[0], messages_);
  if (ends[0] >= 0) close(ends[0]);
  images_ = ends[1];
  if (error == 0) {
    fcntl(images_, F_SETPIPE_SZ, kPipe);  // a smaller pipe is only slower
    return;
  }
  process_ = -1;
  for (const int fd : {images_, messages_})
    if (fd >= 0) close(fd);
  throw Error(name_ + ": cannot be written: ffmpeg does not start: " + std::strerror(error));
}

FilmEncoder::~FilmEncoder() {
  if (process_ > 0) {
    kill(process_, SIGKILL);
    wait();
  }
  close(messages_);
}

void FilmEncoder::write(const uint8_t* rgb) {
  const NoPipeSignal none;
  for (size_t left = image_bytes_; left > 0;) {
    const ssize_t done = ::write(images_, rgb, left);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) fail(wait());
    rgb += done;
    left -= static_cast<size_t>(done);
  }
}

void FilmEncoder::finish() {
  const int status = wait();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail(status);
}

int FilmEncoder::wait() {
  close(std::exchange(images_, -1));
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  return status;
}

void FilmEncoder::fail(int status) const {
  struct stat messages = {};
  fstat(messages_, &messages);
  std::string text(static_cast<size_t>(std::min(messages.st_size, kMessages)), '\0');
  const ssize_t got = pread(messages_, text.data(), text.size(), messages.st_size - static_cast<off_t>(text.size()));
  text.resize(static_cast<size_t>(std::max<ssize_t>(got, 0)));
  std::string last = WIFSIGNALED(status) ? "signal " + std::to_string(WTERMSIG(status)) + " ended it"
                                         : "exit status " + std::to_string(WEXITSTATUS(status));
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.find_first_not_of(" \r\t") != std::string::npos) last = line;
  throw Error(name_ + ": cannot be written: ffmpeg failed: " + last);
}

}  // namespace viscera::cli
