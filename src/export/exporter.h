// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "export/writers.h"

namespace viscera {

enum class ExportFormat { kVtp, kXdmf, kPly, kGlb, kPc2, kUsda };

struct ExportOptions {
  ExportSource source = ExportSource::kSkin;
  ExportFormat format = ExportFormat::kVtp;
  ExportFrame frame = ExportFrame::kRos;
  double every_s = 0.1;
};

/// Writes moments of a session to files, one per moment or one for all, as the format requires.
class Exporter {
 public:
  /// @param folder  is created   @throws Error  it cannot be created; the format does not support the source
  Exporter(const std::string& folder, const ExportOptions& options, double tick_s);
  /// Returns whether a moment is due after this tick, counted from 1.
  bool isDue(uint64_t tick) const { return tick % ticks_ == 0; }
  bool ofSkin() const { return options_.source == ExportSource::kSkin; }
  /// Writes a moment. @param skin  of the session's last tick; unused unless ofSkin()   @throws Error
  void add(const Session& session, const VisibleMesh& skin);
  void finish();  ///< @throws Error

 private:
  void addFile(const Session& session, const VisibleMesh& skin);
  void addVtk(const FieldMesh& mesh);

  ExportOptions options_;
  std::string stem_;  ///< of all paths
  uint64_t ticks_;    ///< between two moments
  std::string collection_;
  std::optional<XdmfSeries> xdmf_;
  std::optional<Pc2Series> pc2_;
  double tick_s_;
  std::optional<UsdSeries> usd_;  ///< from the first moment on
};

}  // namespace viscera
