// SPDX-License-Identifier: MIT
#include "orbitutte/export/export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <sstream>

#include "base64_text.h"
#include "orbitutte/export/export_files.h"
#include "orbitutte/geometry/space.h"
#include "orbitutte/io/bytes.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/io/ply.h"
#include "orbitutte/mesh/triangulation.h"
#include "polygon_meshes.h"
#include "sample_embeddings.h"

namespace orbitutte::export_test {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;
using ::testing::Each;
using ::testing::HasSubstr;

const std::vector<TextureChart> charts = {TextureChart::stereographic, TextureChart::equirectangular,
                                          TextureChart::octahedral};

ExportedModel model(const std::string& signature, TextureChart chart = TextureChart::stereographic) {
  const test::SampleEmbedding& sample = test::sample_embedding(signature);
  return exported_model(test::unjudged(sample.mesh), sample.embedding(), chart);
}

Vector2d uv(const TextureCoordinates& texture, Eigen::Index f, int k) {
  return texture.uv.row(texture.of_corner[3 * f + k]);
}

Vector3 corner(const Embedding& embedding, Eigen::Index f, int k) {
  return embedding.positions.row(embedding.triangles(f, k));
}

/// The points of the sphere whose longitude and latitude, or place on the unfolded octahedron, these are.
Vector3 from_equirectangular(const Vector2d& uv) {
  const double longitude = 2 * pi * (uv.x() - 0.5), latitude = pi * (uv.y() - 0.5);
  return {std::cos(latitude) * std::sin(longitude), std::sin(latitude),
          std::cos(latitude) * std::cos(longitude)};
}

Vector3 from_octahedral(const Vector2d& uv) {
  const Vector2d q = 2 * uv - Vector2d::Ones();
  const double z = 1 - q.lpNorm<1>();
  const auto unfold = [&](double a, double b) { return (a < 0 ? -1 : 1) * (1 - std::abs(b)); };
  const Vector3 p =
      z >= 0 ? Vector3(q.x(), q.y(), z) : Vector3(unfold(q.x(), q.y()), unfold(q.y(), q.x()), z);
  return p.normalized();
}

TEST(TextureChart, LongitudesAndOctahedraLeadBackToTheSphere) {
  for (const std::string& signature : test::sample_signatures()) {
    const Embedding& embedding = test::sample_embedding(signature).embedding();
    const TextureCoordinates longitudes = texture_coordinates(embedding, TextureChart::equirectangular),
                             octahedron = texture_coordinates(embedding, TextureChart::octahedral);
    for (Eigen::Index f = 0; f < embedding.triangles.rows(); ++f) {
      for (int k = 0; k < 3; ++k) {
        const int l = (k + 1) % 3;
        const double expected = corner(embedding, f, k).dot(corner(embedding, f, l));
        EXPECT_NEAR(
            from_equirectangular(uv(longitudes, f, k)).dot(from_equirectangular(uv(longitudes, f, l))),
            expected, 1e-12);
        EXPECT_NEAR(from_octahedral(uv(octahedron, f, k)).dot(from_octahedral(uv(octahedron, f, l))),
                    expected, 1e-12);
      }
    }
  }
}

// The stereographic projection keeps cross ratios: |ab||cd| / (|ac||bd|) of chords.
TEST(TextureChart, StereographicCoordinatesKeepCrossRatios) {
  for (const std::string& signature : test::sample_signatures()) {
    const Embedding& embedding = test::sample_embedding(signature).embedding();
    const TextureCoordinates texture = texture_coordinates(embedding, TextureChart::stereographic);
    const auto ratio = [](const auto& a, const auto& b, const auto& c, const auto& d) {
      return (a - b).norm() * (c - d).norm() / ((a - c).norm() * (b - d).norm());
    };
    for (Eigen::Index f = 0; f + 7 < embedding.triangles.rows(); f += 5) {
      const Eigen::Index g = f + 7;
      if (embedding.triangles(g, 0) == embedding.triangles(f, 1) ||
          embedding.triangles(g, 0) == embedding.triangles(f, 2) ||
          embedding.triangles(g, 0) == embedding.triangles(f, 0))
        continue;
      const double flat = ratio(uv(texture, f, 0), uv(texture, f, 1), uv(texture, f, 2), uv(texture, g, 0));
      const double round = ratio(corner(embedding, f, 0), corner(embedding, f, 1), corner(embedding, f, 2),
                                 corner(embedding, g, 0));
      EXPECT_NEAR(flat, round, 1e-9 * round) << signature;
    }
  }
}

TEST(TextureChart, CoordinatesLieInTheUnitSquareButAcrossTheDateLine) {
  for (const std::string& signature : test::sample_signatures()) {
    for (const TextureChart chart : charts) {
      const TextureCoordinates texture =
          texture_coordinates(test::sample_embedding(signature).embedding(), chart);
      const double right = chart == TextureChart::equirectangular ? 1.5 : 1.0;
      for (const int row : texture.of_corner) {
        EXPECT_GE(texture.uv.row(row).minCoeff(), 0);
        EXPECT_LE(texture.uv(row, 0), right);
        EXPECT_LE(texture.uv(row, 1), 1);
      }
      EXPECT_GE(texture.max_area_distortion, 1);
      EXPECT_TRUE(std::isfinite(texture.max_area_distortion));
    }
  }
}

TEST(TextureChart, NoFaceReachesAroundTheSphere) {
  for (const std::string& signature : test::sample_signatures()) {
    const TextureCoordinates texture =
        texture_coordinates(test::sample_embedding(signature).embedding(), TextureChart::equirectangular);
    for (std::size_t h = 0; h < texture.of_corner.size(); h += 3) {
      const auto latitude = [&](std::size_t k) {
        return std::abs(texture.uv(texture.of_corner[h + k], 1) - 0.5);
      };
      if (std::max({latitude(0), latitude(1), latitude(2)}) > 0.4) continue;  // it may hold a pole
      for (int k = 0; k < 3; ++k)
        EXPECT_LE(std::abs(texture.uv(texture.of_corner[h + k], 0) -
                           texture.uv(texture.of_corner[h + (k + 1) % 3], 0)),
                  0.5);
    }
  }
}

TEST(TextureChart, SmallTilesAreHardlyDistorted) {
  EXPECT_LT(model("532").texture.max_area_distortion, 1.3);
  EXPECT_LT(model("*532").texture.max_area_distortion, 1.2);
}

TEST(TextureChart, NamesAreRead) {
  for (const TextureChart chart : charts)
    EXPECT_EQ(parse_choice<TextureChart>(name_of(chart), "chart"), chart);
  EXPECT_THROW(parse_choice<TextureChart>("mercator", "chart"), ArgumentError);
}

/// The faces of the input.
Polygons faces_of(const ExportedModel& exported) {
  const FaceView faces = exported.surface.faces();
  Polygons result;
  for (int f = 0; f < faces.count(); ++f) {
    result.corners.insert(result.corners.end(), faces[f].begin(), faces[f].end());
    result.start.push_back(static_cast<int>(result.corners.size()));
  }
  return result;
}

class ExportFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    const ::testing::TestInfo& test = *::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / (std::string("orbitutte_export_") + test.name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& file) const { return (folder_ / file).string(); }

  /// The file holds the input's vertices and faces.
  void expect_input(const ExportedModel& exported, const std::string& file) const {
    const PolygonMesh back = read_mesh(path(file));
    EXPECT_EQ(back.V, exported.surface.V) << exported.embedding.target.signature;
    const Polygons faces = faces_of(exported);
    EXPECT_EQ(back.corners, faces.corners) << exported.embedding.target.signature;
    EXPECT_EQ(back.face_start, faces.start) << exported.embedding.target.signature;
  }

  std::filesystem::path folder_;
};

TEST_F(ExportFiles, ObjKeepsTheInputAndTellsSeamsInTextureCoordinatesOnly) {
  for (const std::string& signature : test::sample_signatures()) {
    for (const TextureChart chart : charts) {
      const ExportedModel exported = model(signature, chart);
      write_model(path("model.obj"), exported);
      expect_input(exported, "model.obj");
    }
  }
}

TEST_F(ExportFiles, ObjNamesACopyOfTheVertexForEveryCorner) {
  for (const char* signature : {"532", "*22", "3*2", "5x"}) {
    const ExportedModel exported = model(signature);
    std::istringstream text(obj_text(exported));
    int corners = 0;
    for (std::string line; std::getline(text, line);) {
      if (line.rfind("f ", 0) != 0) continue;
      std::istringstream words(line.substr(2));
      int vertex = 0, pair = 0;
      for (char slash = 0; words >> vertex >> slash >> pair; ++corners)
        EXPECT_EQ(exported.embedding.source_vertex[pair - 1], vertex - 1) << signature;
    }
    EXPECT_EQ(corners, 3 * exported.surface.triangle_count());
  }
}

TEST_F(ExportFiles, PlyHoldsTheLogarithmOfTheAreaDistortion) {
  const ExportedModel exported = model("432");
  write_model(path("model.ply"), exported);
  const PlyFile file = parse_ply(read_file(path("model.ply")));
  const std::vector<double>& quality = file.find("face")->find("quality")->values;
  ASSERT_EQ(quality.size(), exported.of_face.size());
  for (std::size_t f = 0; f < quality.size(); ++f)
    EXPECT_NEAR(std::exp2(quality[f]), exported.of_face[f].area, 1e-5 * exported.of_face[f].area);
  EXPECT_EQ(file.find("vertex")->find("quality")->values.size(),
            static_cast<std::size_t>(exported.surface.V.rows()));
  expect_input(exported, "model.ply");
}

TEST_F(ExportFiles, EveryFormatIsWrittenForEveryFamily) {
  for (const std::string& signature : test::sample_signatures()) {
    for (const std::string& ending : model_endings()) {
      const std::string file = ending == ".vtp" ? "m.VTP" : "m" + ending;
      write_model(path(file), model(signature));
      EXPECT_GT(std::filesystem::file_size(path(file)), 1000u) << signature;
    }
  }
}

TEST_F(ExportFiles, OtherEndingsAndMissingFoldersAreRefused) {
  EXPECT_THROW(write_model(path("m.fbx"), model("532")), ArgumentError);
  EXPECT_THROW(write_model(path("no/m.obj"), model("532")), FileError);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

// Faces of five corners and more on a sphere, quadrilaterals on a disk and on a projective plane, where some
// of the cut mesh are turned over.
PolygonMesh polygons_for(const std::string& signature) {
  const Target orbifold = parse_orbifold(signature);
  if (orbifold.topology == Topology::sphere) return test::dual(test::perturbed(test::icosphere(2), 0.03, 7));
  if (orbifold.topology == Topology::disk)
    return test::quadrangulated(test::perturbed(test::round_disk(5), 0.02, 7));
  return test::quadrangulated(test::projective_plane(2));
}

ExportedModel polygon_model(const std::string& signature, TextureChart chart = TextureChart::stereographic) {
  const PolygonMesh mesh = polygons_for(signature);
  const Target orbifold = parse_orbifold(signature);
  EmbedOptions options;
  options.weights.kind = WeightKind::uniform;
  const EmbedResult result = embed(mesh, orbifold, choose_cones(mesh, orbifold), options);
  return exported_model(test::unjudged(mesh), result.embedding, chart);
}

const std::vector<std::string> polygon_signatures = {"432", "*223", "2x"};

TEST_F(ExportFiles, PolygonsStayWholeInObjAndPly) {
  for (const std::string& signature : polygon_signatures) {
    const ExportedModel exported = polygon_model(signature);
    for (const std::string file : {"model.obj", "model.ply"}) {
      write_model(path(file), exported);
      expect_input(exported, file);
    }
  }
}

TEST_F(ExportFiles, EveryCornerOfAPolygonHasTheTextureOfItsOwnVertex) {
  bool any_turned = false;
  for (const std::string& signature : polygon_signatures) {
    for (const TextureChart chart : charts) {
      const ExportedModel exported = polygon_model(signature, chart);
      const std::vector<int>& corners = exported.surface.polygons.corners;
      std::istringstream text(obj_text(exported));
      std::size_t corner = 0;
      for (std::string line; std::getline(text, line);) {
        if (line.rfind("f ", 0) != 0) continue;
        std::istringstream words(line.substr(2));
        int vertex = 0, pair = 0;
        for (char slash = 0; words >> vertex >> slash >> pair; ++corner) {
          EXPECT_EQ(vertex - 1, corners[corner]);
          if (pair <= static_cast<int>(exported.embedding.source_vertex.size()))  // others are a turn further
            EXPECT_EQ(exported.embedding.source_vertex[pair - 1], vertex - 1) << signature;
        }
      }
      EXPECT_EQ(corner, corners.size());
      const Polygons& cut = exported.embedding.polygons;
      for (std::size_t c = 0; c < cut.corners.size(); ++c)
        any_turned |= exported.embedding.source_vertex[cut.corners[c]] != corners[c];
    }
  }
  EXPECT_TRUE(any_turned)
      << "no face of the projective plane is turned over: the test tests less than it says";
}

TEST_F(ExportFiles, ThePolygonsOfTheCutMeshAreTheCellsOfVtp) {
  for (const std::string& signature : polygon_signatures) {
    const ExportedModel exported = polygon_model(signature);
    const std::string text = vtp_text(exported);
    const auto array = [&](const std::string& name) {
      const std::size_t begin = text.find('>', text.find("Name=\"" + name + "\"")) + 1;
      return test::from_base64(text.substr(begin, text.find('<', begin) - begin))
          .substr(sizeof(std::uint64_t));
    };
    const auto integers = [&](const std::string& name) {
      const std::string bytes = array(name);
      std::vector<int> values;
      for (std::size_t at = 0; at < bytes.size(); at += sizeof(int))
        values.push_back(load<int>(bytes.data() + at, std::endian::little));
      return values;
    };
    const Polygons& cut = exported.embedding.polygons;
    EXPECT_EQ(integers("connectivity"), cut.corners);
    EXPECT_EQ(integers("offsets"), std::vector<int>(cut.start.begin() + 1, cut.start.end()));
    EXPECT_THAT(text, HasSubstr("NumberOfPolys=\"" + std::to_string(cut.count()) + "\""));
    for (const char* name : {"log2_area", "angle"})
      EXPECT_EQ(array(name).size(), sizeof(double) * static_cast<std::size_t>(cut.count()));
  }
}

TEST_F(ExportFiles, GlbHoldsPolygonsInTriangles) {
  for (const std::string& signature : polygon_signatures) {
    const ExportedModel exported = polygon_model(signature);
    const Polygons& polygons = exported.surface.polygons;
    const int expected = static_cast<int>(polygons.corners.size()) - 2 * polygons.count();
    EXPECT_EQ(exported.surface.triangle_count(), expected);
    EXPECT_THAT(glb_bytes(exported), HasSubstr("\"count\":" + std::to_string(3 * expected)));
  }
}

// The ratios of polygons, weighted with their share of the source, are their shares of the tile: in all, one.
TEST(Export, AreaRatiosOfPolygonsAddUpToTheTile) {
  for (const std::string& signature : polygon_signatures) {
    const ExportedModel exported = polygon_model(signature);
    const Surface& surface = exported.surface;
    std::vector<double> area(surface.polygons.count(), 0.0);
    double total = 0;
    for (Eigen::Index t = 0, f = 0; t < surface.triangles.rows(); ++t) {
      while (surface.division(t, 0) >= surface.polygons.start[f + 1]) ++f;
      const auto corner = [&](int k) { return Vector3(surface.V.row(surface.triangles(t, k))); };
      area[f] += (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm() / 2;
    }
    for (const double a : area) total += a;
    double share = 0;
    for (std::size_t f = 0; f < area.size(); ++f) {
      EXPECT_GT(exported.of_face[f].area, 0);
      EXPECT_GE(exported.of_face[f].angle, 1);
      share += exported.of_face[f].area * area[f] / total;
    }
    EXPECT_NEAR(share, 1, 1e-9) << signature;
  }
}

TEST(Export, AnEmbeddingOfAnotherMeshIsRefused) {
  const test::SampleEmbedding& sample = test::sample_embedding("532");
  Mesh other = sample.mesh;
  other.F.row(0).swap(other.F.row(1));
  EXPECT_THROW(exported_model(test::unjudged(other), sample.embedding(), TextureChart::stereographic),
               MeshError);
  EXPECT_THROW(
      exported_model(test::unjudged(test::icosphere(1)), sample.embedding(), TextureChart::stereographic),
      MeshError);
}

}  // namespace
}  // namespace orbitutte::export_test
