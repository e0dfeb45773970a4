// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "math/archive.h"

namespace viscera {

// File of sections: the sixteen bytes of kMagic, version and number of sections as 32 bits each, then the sections.
// Each has the length of its name (32 bits), its number of bytes (64 bits), a CRC-32 of these two numbers, the name and
// the bytes, then the name and the bytes. All numbers are little-endian.

/// Version of the format and of the content of sections: grows with either, as older files cannot be read then.
constexpr uint32_t kStateVersion = 9;

/// Writes a file next to the target and renames it once all of it is on disk: after any failure the file is the old or
/// the new one.
/// @throws Error  it cannot be written
void writeStateFile(const std::string& path, const std::vector<Archive::Section>& sections);
/// Reads a file. @throws Error  it is missing, of another version, too short or too long, or some bit of it is wrong
std::vector<Archive::Section> readStateFile(const std::string& path);
/// Returns the bytes of such a file.
std::string stateBytes(const std::vector<Archive::Section>& sections);
/// Reads sections from bytes. @param name  source of the bytes, for errors   @throws Error  as readStateFile()
std::vector<Archive::Section> readStateBytes(const std::string& bytes, const std::string& name);

}  // namespace viscera
