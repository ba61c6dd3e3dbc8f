// SPDX-License-Identifier: MIT
#include "orbitutte/render/picture_parts.h"

#include "orbitutte/render/default_view.h"

namespace orbitutte {
namespace {

// The embedding's faces on the vertices of the source: those of the mesh, some turned over on projective
// planes.
Triangles source_faces(const Embedding& embedding) {
  Triangles faces = embedding.triangles;
  for (int& v : faces.reshaped()) v = embedding.source_vertex[v];
  return faces;
}

}  // namespace

const SourceFigure& PictureParts::figure() {
  if (!figure_) figure_.emplace(subject_.surface.V, source_faces(subject_.embedding));
  return *figure_;
}

const View& PictureParts::source_view() {
  if (source_view_) return *source_view_;
  const bool is_of_sphere = options_.panel == Panel::sphere;  // then view and up are the sphere's
  const Vector3 up = options_.up && !is_of_sphere ? *options_.up : default_up_direction(subject_.surface);
  source_view_ = options_.view && !is_of_sphere ? View{options_.view->normalized(), up}
                                                : default_view(figure(), marked_positions(), up);
  return *source_view_;
}

const std::vector<FaceDistortion>& PictureParts::distortion() {
  if (!distortion_) distortion_ = measure_triangles(subject_.surface, subject_.embedding);
  return *distortion_;
}

Points PictureParts::marked_positions() {
  std::vector<int> vertices;
  for (const ConeCopies& cone : embedding().cones) vertices.push_back(cone.vertex);
  return polyline(figure().positions(), vertices);
}

}  // namespace orbitutte
