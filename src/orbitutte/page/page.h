// SPDX-License-Identifier: MIT
// The report of an embedding as one HTML file that needs nothing else (docs/page.md).
#pragma once

#include <string>
#include <vector>

#include "orbitutte/export/display_mesh.h"

namespace orbitutte {

/// A picture that stands in for the interactive view.
struct PagePicture {
  std::string caption;
  /// The bytes.
  std::string png;
};

/// What the page has besides figures.
struct PageOptions {
  /// With the view that needs JavaScript and WebGL, if this build has it and the map is one onto the sphere.
  bool interactive = true;
  /// Shown where the page has no interactive view, or it cannot run.
  std::vector<PagePicture> pictures;
  /// How much of the mesh the interactive view draws.
  DisplayLimits limits;
};

/// What the page is about. The surface is the one that was embedded; its colours are shown.
struct PageSubject {
  const Surface& surface;
  const Embedding& embedding;
  /// JSON, as report_json writes it.
  const std::string& report;
};

/// Whether this build of the library holds the script of the interactive view (Node.js made it).
bool has_interactive_view();

/// The page. The certificate is computed again from mesh and embedding, and the page says where the report
/// claims otherwise; other figures are the report's, those that it lacks a dash. Everything the page shows is
/// in it, and a content security policy keeps it from loading anything. Throws MeshError where mesh and
/// embedding do not belong together, there are colours of other vertices, or the report is no JSON,
/// ArgumentError as weld_copies does.
std::string report_page(const PageSubject& subject, const PageOptions& options = {});

}  // namespace orbitutte
