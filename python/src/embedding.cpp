// SPDX-License-Identifier: MIT
// What is asked of an embedding: its arrays, its files, its certificate and measures.
#include <pybind11/stl.h>

#include "arrays.h"
#include "held_embedding.h"
#include "orbitutte/export/tiling.h"
#include "orbitutte/io/file.h"
#include "orbitutte/map/point_map.h"
#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/orbifold/symmetry_group.h"
#include "orbitutte/report/embedding_file.h"
#include "orbitutte/report/verification.h"

namespace orbitutte::python {

py::dict to_dict(const Distortion& measured) {
  using namespace py::literals;
  const auto& [mean, std, median, max] = measured.area;
  return py::dict(
      "area"_a = py::dict("mean"_a = mean, "std"_a = std, "median"_a = median, "max"_a = max),
      "angle"_a = py::dict("mean"_a = measured.angle.mean, "area_mean"_a = measured.angle.area_mean,
                           "median"_a = measured.angle.median, "max"_a = measured.angle.max),
      "sigma"_a = measured.sigma, "within_4"_a = measured.within_4, "below_64"_a = measured.below_64,
      "histogram"_a = py::dict("quantity"_a = "log2 of the area ratio", "edges"_a = measured.histogram.edges,
                               "counts"_a = measured.histogram.counts),
      "measured_faces"_a = measured.measured_faces);
}

namespace {

// As in the report.
py::dict strain_dict(const std::vector<StrainStatistics>& strain) {
  using namespace py::literals;
  py::dict result;
  for (std::size_t k = 0; k < strain.size(); ++k) {
    py::dict percentiles;
    for (std::size_t p = 0; p < std::size(StrainStatistics::percents); ++p)
      percentiles[py::str(std::to_string(StrainStatistics::percents[p]))] = strain[k].percentiles[p];
    result[py::str(name_of(static_cast<StrainMeasure>(k)))] =
        py::dict("mean"_a = strain[k].mean, "mean_absolute"_a = strain[k].mean_absolute,
                 "percentiles"_a = percentiles);
  }
  return result;
}

using Held = std::shared_ptr<HeldEmbedding>;
using MaybeMesh = std::shared_ptr<const SourceMesh>;
using Release = py::call_guard<py::gil_scoped_release>;

// (kind, left, right, transform) of each.
py::list seams(const HeldEmbedding& held) {
  py::list result;
  for (const Seam& seam : held.embedding.seams)
    result.append(py::make_tuple(name_of(seam.kind()), copy(seam.left), copy(seam.right),
                                 copy(seam.transform.matrix())));
  return result;
}

// (vertex, order, kind, copies) of each.
py::list cones(const HeldEmbedding& held) {
  py::list result;
  for (const ConeCopies& cone : held.embedding.cones)
    result.append(py::make_tuple(cone.vertex, cone.mark.order(), name_of(cone.mark.kind), copy(cone.copies)));
  return result;
}

// The elements that SurfacePoints::copy counts, in the frame of the positions.
py::array group(const HeldEmbedding& held) {
  std::vector<Matrix3> matrices;
  const SymmetryGroup elements = group_of(held.embedding, PointLocator::default_copies);
  for (const Isometry& element : elements.elements()) matrices.push_back(element.matrix());
  return copy(matrices);
}

py::tuple polygons(const Held& held) {
  const py::object owner = py::cast(held);
  const Polygons& faces = held->embedding.polygons;
  return py::make_tuple(view(faces.corners, owner), view(faces.start, owner));
}

// The edges (k x 2) and one weight for each.
py::tuple weights(const HeldEmbedding& held) {
  const EdgeWeights weights = held.edge_weights();
  const Connectivity& connectivity = weights.triangulation
                                         ? weights.triangulation->connectivity
                                         : held.source("the list of edges").surface()->connectivity;
  std::vector<int> i, j;
  for (const auto& edge : connectivity.edges) {
    i.push_back(edge[0]);
    j.push_back(edge[1]);
  }
  return py::make_tuple(copy(i), copy(j),
                        copy(std::vector<double>(weights.w.data(), weights.w.data() + weights.w.size())));
}

// A and the ratio of singular values of every triangle.
py::tuple face_distortion(const HeldEmbedding& held) {
  const std::vector<FaceDistortion> faces =
      measure_triangles(*held.source("distortion").surface(), held.embedding);
  std::vector<double> area, angle;
  for (const FaceDistortion& face : faces) {
    area.push_back(face.area);
    angle.push_back(face.angle);
  }
  return py::make_tuple(copy(area), copy(angle));
}

// With the keys of the report.
py::dict distortion(const HeldEmbedding& held) {
  const Surface& surface = *held.source("distortion").surface();
  py::dict result = to_dict(measure_distortion(surface, held.embedding));
  result["strain"] = strain_dict(strain_statistics(measure_strain(surface, held.embedding).at_vertices));
  return result;
}

VerificationOptions verification_options(const HeldEmbedding& held, const std::string& weights_file,
                                         const std::string& depth) {
  VerificationOptions options;
  options.weights_file = weights_file;
  options.theorem2 = depth == "theorem2";
  const bool given = held.weights && held.weights->kind == WeightKind::file;
  if (given && weights_file.empty()) options.weights = held.weights;
  return options;
}

// The mesh that an embedding is of: repaired if its report says that it was, and this one has not been yet.
MaybeMesh as_embedded(MaybeMesh mesh, const Report& report) {
  return mesh && report.is_repaired && !mesh->repair() ? MaybeMesh(mesh->repaired().first) : mesh;
}

// Judges the embedding from the data alone. If no file is named, the weights that the caller gave are used,
// if they are known.
std::string verify_again(const HeldEmbedding& held, const MaybeMesh& mesh, const std::string& weights_file,
                         const std::string& depth) {
  const Report claims = parse_report(held.brief_report());
  const MaybeMesh given = as_embedded(mesh, claims);
  const SourceMesh& judge = given ? *given : held.source("verification");
  return verdict_json(
      verify(*judge.surface(), held.embedding, claims, verification_options(held, weights_file, depth)));
}

Tiling tiled(const HeldEmbedding& held) { return weld_copies(held.embedding); }

// (V, triangles, polygons' corners and starts, copy of each triangle)
py::tuple tile(const HeldEmbedding& held) {
  Tiling tiling;
  {
    const py::gil_scoped_release release;
    tiling = tiled(held);
  }
  return py::make_tuple(take(std::move(tiling.mesh.V)), take(std::move(tiling.mesh.F)),
                        take(std::move(tiling.polygons.corners)), take(std::move(tiling.polygons.start)),
                        take(std::move(tiling.copy)));
}

// The vertices (k) and what their positions have beyond their doubles (k x 3).
py::tuple offsets(const HeldEmbedding& held) {
  const std::vector<Offset>& offsets = held.embedding.offsets;
  std::vector<int> vertices;
  Points differences(static_cast<Eigen::Index>(offsets.size()), 3);
  for (std::size_t k = 0; k < offsets.size(); ++k) {
    vertices.push_back(offsets[k].vertex);
    differences.row(static_cast<Eigen::Index>(k)) = offsets[k].d;
  }
  return py::make_tuple(take(std::move(vertices)), take(std::move(differences)));
}

Held loaded(Embedding embedding, std::string report, MaybeMesh mesh) {
  const Report claims = parse_report(report);
  embedding = with_report(std::move(embedding), claims);
  mesh = as_embedded(std::move(mesh), claims);
  if (mesh) embedding = mesh->belonging(std::move(embedding));
  auto held = std::make_shared<HeldReport>(std::move(report), HeldReport::Strain::included);
  return std::make_shared<HeldEmbedding>(
      HeldEmbedding{std::move(embedding), std::move(held), std::move(mesh), std::nullopt});
}

// Messages begin with the path concerned.
Held load(const std::string& ply, const std::string& json, MaybeMesh mesh) {
  Embedding embedding = read_embedding(ply, read_report(json));
  return loaded(std::move(embedding), read_file(json), std::move(mesh));
}

Held unpickled(const py::bytes& ply, std::string report, MaybeMesh mesh) {
  return loaded(parse_embedding(std::string(ply)), std::move(report), std::move(mesh));
}

void save(const HeldEmbedding& held, const std::string& ply, const std::string& json) {
  write_file(ply, serialize_embedding(held.embedding));
  if (!json.empty()) write_file(json, held.report());
}

Held with_mesh(const HeldEmbedding& held, MaybeMesh mesh) {
  held.report();  // its strain is that of the mesh that was embedded
  auto result = std::make_shared<HeldEmbedding>(held);
  mesh = as_embedded(std::move(mesh), parse_report(held.brief_report()));
  result->embedding = mesh->belonging(std::move(result->embedding));
  result->mesh = std::move(mesh);
  return result;
}

}  // namespace

void bind_embedding(py::module_& module) {
  py::class_<HeldEmbedding, Held>(module, "Embedding")
      .def_property_readonly("positions",
                             [](const Held& held) { return view(held->embedding.positions, py::cast(held)); })
      .def_property_readonly("canonical_positions",
                             [](const Held& held) { return take(held->embedding.canonical_positions()); })
      .def_property_readonly(
          "placement", [](const HeldEmbedding& held) { return copy(held.embedding.placement.matrix()); })
      .def_property_readonly("offsets", &offsets)
      .def_property_readonly("offset_warnings",
                             [](const HeldEmbedding& held) { return warnings_of_offsets(held.embedding); })
      .def_property_readonly(
          "is_free_to_rotate",
          [](const HeldEmbedding& held) { return held.embedding.target.is_free_to_rotate; })
      .def_property_readonly("triangles",
                             [](const Held& held) { return view(held->embedding.triangles, py::cast(held)); })
      .def_property_readonly("polygons", &polygons)
      .def_property_readonly(
          "source_vertex",
          [](const Held& held) { return view(held->embedding.source_vertex, py::cast(held)); })
      .def_property_readonly("seams", &seams)
      .def_property_readonly("cones", &cones)
      .def_property_readonly("group", &group)
      .def_property_readonly(
          "mesh", [](const HeldEmbedding& held) { return std::const_pointer_cast<SourceMesh>(held.mesh); })
      .def_property_readonly("report", py::cpp_function(&HeldEmbedding::report, Release()))
      .def_property_readonly("brief_report", &HeldEmbedding::brief_report)
      .def("ply", [](const HeldEmbedding& held) { return py::bytes(serialize_embedding(held.embedding)); })
      .def("weights", &weights)
      .def("face_distortion", &face_distortion)
      .def("distortion", &distortion)
      .def("verify", &verify_again, Release())
      .def("tile", &tile)
      .def(
          "write_tiling",
          [](const HeldEmbedding& held, const std::string& path) { write_tiling(path, tiled(held)); },
          Release())
      .def("save", &save, Release())
      .def("with_mesh", &with_mesh, Release());
  module.def("load", &load, Release());
  module.def("unpickled", &unpickled);
}

}  // namespace orbitutte::python
