// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gdcmTrace.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>

#include "cli/dicom/frames.h"

// viscera-dicom list PATH | read PATH SERIES LAYER fill|refuse: started and read by src/model/scan/dicom.cpp. It is a
// separate process, since GDCM may fail on corrupt files (assertions, unbounded memory).
namespace viscera::dicom {
namespace {

char reading[4096] = "";  ///< the file being read

/// Prints one line that names the file, when GDCM ends the process by an assertion or a signal.
void sayFile(int) {
  const char what[] =
      ": the library that reads DICOM crashed on it; accepted: undamaged files. Remove it from the folder\n";
  if (ftruncate(STDERR_FILENO, 0) == 0) lseek(STDERR_FILENO, 0, SEEK_SET);  // removes GDCM's own messages
  const bool said =
      write(STDERR_FILENO, reading, std::strlen(reading)) >= 0 && write(STDERR_FILENO, what, sizeof what - 1) >= 0;
  _exit(said ? 1 : 3);
}

void requireWritten(bool written) {
  if (!written) std::_Exit(1);  // the reader has closed the pipe
}

void list(const std::string& path) {
  const std::vector<Series> all = seriesOf(path);
  std::printf("%zu\n", all.size());
  for (const Series& series : all)
    std::printf("%s %s %zu %s\n", series.uid.c_str(), series.modality.c_str(), series.files.size(),
                series.description.c_str());
}

void read(const std::string& path, const std::string& asked, int layer, bool fill) {
  std::vector<Series> all = seriesOf(path);
  if (asked == "all") {
    for (size_t n = 1; n < all.size(); ++n)
      all[0].files.insert(all[0].files.end(), all[n].files.begin(), all[n].files.end());
    all.resize(1);
  }
  std::string known;
  const Series* chosen = all.size() == 1 && (asked.empty() || asked == "all") ? &all[0] : nullptr;
  for (size_t n = 0; n < all.size(); ++n) {
    if (asked == all[n].uid || asked == std::to_string(n)) chosen = &all[n];
    if (n < 20)
      known += (n > 0 ? "; " : " ") + std::to_string(n) + ": " + all[n].uid + ", " + all[n].modality + ", " +
               std::to_string(all[n].files.size()) + " files, " + all[n].description;
  }
  if (!chosen)
    throw SceneError(path + ": " + (asked.empty() ? "contains several series" : "has no series '" + asked + "'") +
                     "; accepted: all, which joins them, or the number or UID of one:" + known);
  if (!isSegmentation(chosen->files[0])) return writeVolume(chosen->files, fill);
  if (chosen->files.size() > 1) throw SceneError(path + ": several segmentation files; name one of them");
  writeSegmentation(chosen->files[0], layer);
}

}  // namespace

void writeHeader(const Stack& stack, int layers, const std::vector<std::string>& segments) {
  std::printf("viscera-dicom-2 %d %d %d %d %zu\n", stack.size[0], stack.size[1], stack.size[2], layers,
              segments.size());
  for (int n = 0; n < 9; ++n) std::printf("%.17g ", stack.axes(n % 3, n / 3));
  std::printf("%.17g %.17g %.17g\n", stack.origin.x(), stack.origin.y(), stack.origin.z());
  for (const std::string& segment : segments) std::printf("%s\n", segment.c_str());
}

void nowReading(const std::string& file) {
  std::snprintf(reading, sizeof reading, "%s", file.c_str());
}

void writeNote(const std::string& note) {
  std::printf("note %s\n", note.c_str());
}

void writeSlice(const std::vector<float>& values) {
  requireWritten(std::fwrite(values.data(), sizeof(float), values.size(), stdout) == values.size());
}

}  // namespace viscera::dicom

int main(int count, char** arguments) {
  using namespace viscera;
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
  gdcm::Trace::DebugOff();
  const std::string what = count > 1 ? arguments[1] : "", path = count > 2 ? arguments[2] : "";
  dicom::nowReading(path);
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL}) std::signal(signal, dicom::sayFile);
  try {
    if (what == "list" && count == 3) {
      dicom::list(path);
    } else if (what == "read" && count == 6) {
      dicom::read(path, arguments[3], std::atoi(arguments[4]), arguments[5] == std::string("fill"));
    } else {
      std::fprintf(
          stderr,
          "usage: viscera-dicom list PATH | read PATH SERIES LAYER fill|refuse; viscera starts it to read DICOM\n");
      return 2;
    }
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "%s: needs more memory than the limit for DICOM\n", dicom::reading);
    return 1;
  } catch (const SceneError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: cannot be read: %s\n", dicom::reading, error.what());
    return 1;
  }
  return std::fflush(stdout) == 0 ? 0 : 1;
}
