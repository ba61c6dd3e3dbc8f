// SPDX-License-Identifier: MIT
// The report of an embedding as one HTML file that needs nothing else (docs/page.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "orbitutte/export/display_mesh.h"
#include "orbitutte/io/vertex_data.h"

namespace orbitutte {

/// A picture that stands in for the interactive view.
struct PagePicture {
  std::string caption;
  /// The bytes.
  std::string png;
};

/// Values at the vertices of the surface, for which its colours stand.
struct ShownValues {
  /// As the page names them.
  std::string name;

  /// n: a value for each vertex; NaN where there is none.
  Eigen::VectorXd values;

  /// If they are labels, their table.
  std::vector<ValueLabel> labels;

  /// The values at both ends of the colours, as ValueColours has them.
  double low = 0, high = 0;
};

/// What the page shows besides figures.
struct PageOptions {
  /// Whether the page has the interactive view, which needs JavaScript and WebGL. It has none if this build
  /// has none or the map is not onto the sphere.
  bool interactive = true;
  /// The pictures that are shown if the page has no interactive view or the view cannot run.
  std::vector<PagePicture> pictures;
  /// How much of the mesh the interactive view draws.
  DisplayLimits limits;
  /// With these the view opens, and has a scale for them.
  std::optional<ShownValues> values = {};
};

/// The subject of the page. The surface is the one that was embedded; its colours are shown.
struct PageSubject {
  const Surface& surface;
  const Embedding& embedding;
  /// JSON, as report_json writes it.
  const std::string& report;
};

/// Does this build of the library contain the script of the interactive view (made by Node.js)?
bool has_interactive_view();

/// The page. The certificate is computed again from mesh and embedding, and the page says so if the report
/// claims something else. The other figures are the report's; if the report lacks one, the page has a dash.
/// The file contains everything that the page shows, and a content security policy keeps it from loading
/// anything. Throws MeshError if mesh and embedding do not belong together, if the colours or values are
/// those of other vertices, or if the report is not JSON; ArgumentError as weld_copies does.
std::string report_page(const PageSubject& subject, const PageOptions& options = {});

}  // namespace orbitutte
