// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tasks/task.h"

namespace viscera {

/// Returns whether a task counts a measure (task_measures.h).
bool isCounted(std::string_view measure, const TaskConfig& task);

/// Returns keys of a task that have no effect, one line each for a person: rules of measures that its kind does not
/// count.
std::vector<std::string> taskNotes(const TaskConfig& task);

}  // namespace viscera
