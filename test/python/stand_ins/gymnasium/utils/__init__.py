# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
