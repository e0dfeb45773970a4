// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/machine/machine.h"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <fstream>
#include <thread>

#include "bench/harness/machine/machine_threads.h"
#include "math/aligned.h"
#include "math/processors.h"

namespace viscera::bench {

namespace {

constexpr int kCopies = 5;

/// Measures one thread with arrays of its own: the best of several copies.
double copyAlone(size_t bytes) {
  AlignedVector<char> from(bytes, 1), to(bytes);
  double best_s = 1e9;
  for (int i = 0; i < kCopies; ++i) {
    const auto start = std::chrono::steady_clock::now();
    std::memcpy(to.data(), from.data(), bytes);
    best_s = std::min(best_s, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    from[static_cast<size_t>(i)] = to[bytes - 1];  // uses the copy, which might otherwise be optimised away
  }
  return 2 * static_cast<double>(bytes) / best_s;
}

}  // namespace

double sumOverThreads(int threads, const std::function<double()>& measure) {
  std::vector<double> results(static_cast<size_t>(threads));
  std::vector<std::thread> others;
  for (size_t t = 1; t < results.size(); ++t) others.emplace_back([&, t] { results[t] = measure(); });
  results[0] = measure();
  for (std::thread& other : others) other.join();
  double sum = 0;
  for (double result : results) sum += result;
  return sum;
}

double copyRate(int threads, size_t mebibytes) {
  return sumOverThreads(threads, [&] { return copyAlone(mebibytes << 20); });
}

double residentBytes() {
  malloc_trim(0);
  std::ifstream stream("/proc/self/statm");
  double size = 0, resident = 0;
  stream >> size >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

int processors() {
  return usableProcessors();
}

}  // namespace viscera::bench
