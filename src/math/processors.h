// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace viscera {

/// Returns how many processors this process may use, > 0: those of its affinity (taskset, cpusets), limited by the
/// processor time of its control groups, rounded up (a container's --cpus, systemd's CPUQuota).
int usableProcessors();

/// Returns the processor time that control groups allow [processors], or nothing where none limits it.
/// @param mount  where the file systems of control groups are, /sys/fs/cgroup
/// @param groups  text of /proc/self/cgroup; of version 1 or 2
std::optional<double> processorQuota(const std::string& mount, const std::string& groups);

}  // namespace viscera
