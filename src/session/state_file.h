// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "math/archive.h"

namespace viscera {

// A file of sections: the sixteen bytes of kMagic, version and number of sections as 32 bits each, then of every
// section the length of its name (32 bits), the bytes that it holds (64 bits), a CRC-32 of these two numbers, the name
// and the bytes, the name, the bytes. All little-endian.

/// Of the format and of what sections hold: grows with either, as older files cannot be read then.
constexpr uint32_t kStateVersion = 7;

/// Written beside the file and put in its place when all of it is on the disk: whatever happens on the way, the file is
/// the old one or the new one. @throws Error
void writeStateFile(const std::string& path, const std::vector<Archive::Section>& sections);
/// @throws Error  it is not there, of another version, cut short, longer, or some bit of it is wrong
std::vector<Archive::Section> readStateFile(const std::string& path);
/// The bytes of such a file.
std::string stateBytes(const std::vector<Archive::Section>& sections);
/// @param name  of where the bytes come from, for errors   @throws Error  as readStateFile()
std::vector<Archive::Section> readStateBytes(const std::string& bytes, const std::string& name);

}  // namespace viscera
