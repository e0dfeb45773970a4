// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "export/exporter.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "math/number_text.h"
#include "math/out_file.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

const char* nameOf(ExportSource source) {
  constexpr const char* kNames[] = {"skin", "lattice", "network", "sutures"};
  return kNames[static_cast<size_t>(source)];
}

std::string numbered(uint64_t tick) {
  char text[32];
  std::snprintf(text, sizeof text, "_%06llu", static_cast<unsigned long long>(tick));
  return text;
}

FieldMesh fieldsOf(const Session& session, const VisibleMesh& skin, const ExportOptions& options) {
  FieldMesh mesh = options.source == ExportSource::kSkin      ? skinFields(session, skin)
                   : options.source == ExportSource::kLattice ? latticeFields(session)
                   : options.source == ExportSource::kNetwork ? networkFields(session)
                                                              : sutureFields(session);
  toFrame(options.frame, session.scene().environment.scan_origin_m, mesh);
  return mesh;
}

}  // namespace

Exporter::Exporter(const std::string& folder, const ExportOptions& options, double tick_s)
    : options_(options),
      stem_(folder + "/" + nameOf(options.source)),
      ticks_(std::max<uint64_t>(1, static_cast<uint64_t>(std::llround(options.every_s / tick_s)))),
      tick_s_(tick_s) {
  const bool fields = options.format == ExportFormat::kVtp || options.format == ExportFormat::kXdmf;
  if (!fields && options.source != ExportSource::kSkin)
    throw Error(
        "--format ply, glb, pc2 and usda contain only skins; use vtp or xdmf for a lattice, a network or sutures");
  if (options.format == ExportFormat::kGlb && options.frame != ExportFrame::kRos)
    throw Error("--format glb is always in metres with y up, as in glTF; use vtp or ply with --export-frame lps_mm");
  if (options.format == ExportFormat::kUsda && options.frame != ExportFrame::kRos)
    throw Error("--format usda is always in metres with z up; use vtp or ply with --export-frame lps_mm");
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(folder + ": cannot create this folder for exports: " + error.message());
  if (options.format == ExportFormat::kXdmf) xdmf_.emplace(stem_);
  if (options.format == ExportFormat::kPc2) pc2_.emplace(stem_ + ".pc2", static_cast<double>(ticks_) * tick_s);
}

void Exporter::add(const Session& session, const VisibleMesh& skin) {
  if (options_.format == ExportFormat::kPly || options_.format == ExportFormat::kGlb) return addFile(session, skin);
  if (options_.format == ExportFormat::kUsda) {
    if (!usd_) usd_.emplace(stem_ + ".usda", session.scene(), 1 / (static_cast<double>(ticks_) * tick_s_));
    return usd_->add(session.tick() / ticks_, skin, session.motions());
  }
  const FieldMesh mesh = fieldsOf(session, skin, options_);
  if (xdmf_) return xdmf_->add(mesh);
  if (pc2_) {
    // The mesh that the cache animates.
    if (!pc2_->begun()) writePly(skin, stem_ + ".ply");
    return pc2_->add(mesh);
  }
  addVtk(mesh);
}

void Exporter::addFile(const Session& session, const VisibleMesh& skin) {
  const std::string path = stem_ + numbered(session.tick());
  if (options_.format == ExportFormat::kGlb) return writeGlb(skin, path + ".glb");
  VisibleMesh moved = skin;
  toFrame(options_.frame, session.scene().environment.scan_origin_m, Vectors::kPositions, moved.positions_m);
  if (options_.frame == ExportFrame::kLpsMm) {
    for (uint32_t& normal : moved.normals) {
      const Vector3f n = unpackNormal(normal);
      normal = packNormal({n.y(), -n.x(), n.z()});
    }
  }
  writePly(moved, path + ".ply");
}

void Exporter::addVtk(const FieldMesh& mesh) {
  const std::string path = stem_ + numbered(mesh.tick) + (mesh.corners == 8 ? ".vtu" : ".vtp");
  writeVtk(mesh, path);
  collection_ += "<DataSet timestep=\"" + exactText(mesh.time_s) + "\" part=\"0\" file=\"" +
                 std::filesystem::path(path).filename().string() + "\"/>\n";
  // Complete after every moment, in case the run is interrupted.
  writeFile(stem_ + ".pvd", FileKind::kVtk,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
            "<Collection>\n" +
                collection_ + "</Collection>\n</VTKFile>\n");
}

void writeSkin(const Session& session, const VisibleMesh& skin, const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".ply") return writePly(skin, path);
  if (ending == ".glb") return writeGlb(skin, path);
  if (ending == ".vtp") return writeVtk(skinFields(session, skin), path);
  throw Error(path + ": must end in .ply, .glb or .vtp");
}

void Exporter::finish() {
  if (xdmf_) xdmf_->finish();
  if (pc2_) pc2_->finish();
  if (usd_) usd_->finish();
}

}  // namespace viscera
