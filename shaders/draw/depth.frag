// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// depth.frag - depths alone.   Owner: render/tissue_painter.h
void main() {}
