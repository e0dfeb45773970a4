// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tasks/task_report.h"

namespace viscera {

/// Returns the page, with everything that it shows embedded.
std::string reportPage(const TaskResult& result, const Attempt& attempt, const std::vector<ReportPicture>& pictures);

}  // namespace viscera
