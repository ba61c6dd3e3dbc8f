// SPDX-License-Identifier: MIT
// GIfTI, FreeSurfer, VTK, glTF and binary OFF files, and compressed ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "orbitutte/io/base64.h"
#include "orbitutte/io/compression.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/gifti.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/samples/sample.h"

namespace orbitutte::brain_formats_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string corpus(const std::string& file) {
  return read_file((fs::path(ORBITUTTE_SOURCE_DIR) / "fuzz/corpus" / file).string());
}

const std::vector<double> corner_points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
const std::vector<int> corner_faces = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};

struct CornerFile {
  std::string name;
  MeshFormat format;
};

class TheSameTetrahedron : public testing::TestWithParam<CornerFile> {};

TEST_P(TheSameTetrahedron, IsRead) {
  const PolygonMesh mesh = parse_mesh(corpus(GetParam().name), GetParam().format);
  EXPECT_EQ(std::vector<double>(mesh.V.data(), mesh.V.data() + mesh.V.size()), corner_points);
  EXPECT_EQ(mesh.corners, corner_faces);
  EXPECT_EQ(mesh.face_start, (std::vector<int>{0, 3, 6, 9, 12}));
}

INSTANTIATE_TEST_SUITE_P(Files, TheSameTetrahedron,
                         testing::Values(CornerFile{"gifti/text.gii", MeshFormat::gifti},
                                         CornerFile{"gifti/columns_big_endian.gii", MeshFormat::gifti},
                                         CornerFile{"gifti/compressed.gii", MeshFormat::gifti},
                                         CornerFile{"freesurfer/tetrahedron", MeshFormat::freesurfer},
                                         CornerFile{"vtk/text.vtk", MeshFormat::vtk},
                                         CornerFile{"vtk/binary.vtk", MeshFormat::vtk},
                                         CornerFile{"vtk/offsets.vtk", MeshFormat::vtk},
                                         CornerFile{"off/binary_tetrahedron.off", MeshFormat::off},
                                         CornerFile{"off/binary_all_columns.off", MeshFormat::off},
                                         CornerFile{"gltf/tetrahedron.gltf", MeshFormat::gltf},
                                         CornerFile{"gltf/tetrahedron.glb", MeshFormat::glb},
                                         CornerFile{"gltf/image.gltf", MeshFormat::gltf},
                                         CornerFile{"vtp/text.vtp", MeshFormat::vtp},
                                         CornerFile{"vtp/binary.vtp", MeshFormat::vtp},
                                         CornerFile{"vtp/binary_zlib.vtp", MeshFormat::vtp},
                                         CornerFile{"vtp/binary_big_endian.vtp", MeshFormat::vtp},
                                         CornerFile{"vtp/appended_raw.vtp", MeshFormat::vtp},
                                         CornerFile{"vtp/appended_raw_zlib.vtp", MeshFormat::vtp},
                                         CornerFile{"vtp/appended_base64.vtp", MeshFormat::vtp},
                                         CornerFile{"vtp/appended_base64_zlib.vtp", MeshFormat::vtp}));

struct BadFile {
  std::string name;
  MeshFormat format;
  std::string message;
};

class Refused : public testing::TestWithParam<BadFile> {};

TEST_P(Refused, WithASentenceThatNamesTheFault) {
  try {
    parse_mesh(corpus(GetParam().name), GetParam().format);
    FAIL() << "was read";
  } catch (const MeshError& error) {
    EXPECT_THAT(error.what(), HasSubstr(GetParam().message));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Files, Refused,
    testing::Values(BadFile{"gifti/promise.gii", MeshFormat::gifti, "DataArray 0"},
                    BadFile{"gifti/no_surface.gii", MeshFormat::gifti, "NIFTI_INTENT_POINTSET"},
                    BadFile{"gifti/external.gii", MeshFormat::gifti, "which is not read"},
                    BadFile{"gifti/cut.gii", MeshFormat::gifti, "no XML"},
                    BadFile{"freesurfer/cut_short", MeshFormat::freesurfer, "promises 4 vertices"},
                    BadFile{"freesurfer/quadrangles", MeshFormat::freesurfer, "mris_convert"},
                    BadFile{"freesurfer/negative", MeshFormat::freesurfer, "promises -4 vertices"},
                    BadFile{"vtk/grid.vtk", MeshFormat::vtk, "POLYDATA"},
                    BadFile{"vtk/cut_short.vtk", MeshFormat::vtk, "cut short"},
                    BadFile{"vtk/promise.vtk", MeshFormat::vtk, "2000000000"},
                    BadFile{"off/binary.off", MeshFormat::off, "the number of vertices is 4, but only"},
                    BadFile{"off/binary_promise.off", MeshFormat::off, "2147483647"},
                    BadFile{"off/binary_more_bytes.off", MeshFormat::off, "bytes follow"},
                    BadFile{"gltf/external.gltf", MeshFormat::gltf, "'tetrahedron.bin', which is not read"},
                    BadFile{"gltf/index_out_of_range.glb", MeshFormat::glb, "names the vertex 9"},
                    BadFile{"gltf/promise.glb", MeshFormat::glb, "4000000000 elements do not fit"},
                    BadFile{"gltf/outside.glb", MeshFormat::glb, "do not fit"},
                    BadFile{"gltf/compressed.glb", MeshFormat::glb, "compressed"},
                    BadFile{"gltf/cut_short.glb", MeshFormat::glb, "no glTF 2.0"},
                    BadFile{"gltf/no_meshes.gltf", MeshFormat::gltf, "no triangles"},
                    BadFile{"vtp/lz4.vtp", MeshFormat::vtp, "vtkLZ4DataCompressor"},
                    BadFile{"vtp/grid.vtp", MeshFormat::vtp, "UnstructuredGrid"},
                    BadFile{"vtp/cut_short.vtp", MeshFormat::vtp, "DataArray"},
                    BadFile{"vtp/offsets_decrease.vtp", MeshFormat::vtp, "the cell 1 ends at 2"},
                    BadFile{"vtp/index_no_number.vtp", MeshFormat::vtp, "'x' stands where a number"},
                    BadFile{"vtp/no_connectivity.vtp", MeshFormat::vtp, "'connectivity'"}));

TEST(Gltf, PrimitivesShareTheVerticesOfOneAccessor) {
  const PolygonMesh mesh = parse_mesh(corpus("gltf/strip_and_triangles.glb"), MeshFormat::glb);
  EXPECT_EQ(mesh.vertex_count(), 4);
  EXPECT_EQ(mesh.corners, (std::vector<int>{0, 2, 1, 0, 1, 3, 1, 2, 3, 3, 2, 0}));
  EXPECT_EQ(mesh.warnings.size(), 1U);  // a node has a transform
}

TEST(Gltf, OfNothingIsNotWritten) {
  EXPECT_THROW(serialize_mesh(Mesh{Points(0, 3), Triangles(0, 3)}, MeshFormat::glb), MeshError);
}

TEST(Vtp, PiecesFollowEachOther) {
  const PolygonMesh mesh = parse_mesh(corpus("vtp/two_pieces.vtp"), MeshFormat::vtp);
  EXPECT_EQ(mesh.vertex_count(), 8);
  EXPECT_EQ(mesh.corners,
            (std::vector<int>{0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3, 4, 6, 5, 4, 5, 7, 5, 6, 7, 6, 4, 7}));
}

TEST(Vtp, StripsAreOrientedTriangles) {
  const PolygonMesh mesh = parse_mesh(corpus("vtp/strip.vtp"), MeshFormat::vtp);
  EXPECT_EQ(mesh.corners, (std::vector<int>{0, 1, 2, 2, 1, 3}));
}

TEST(BinaryOff, HasColoursOfVerticesAndSkipsThoseOfFaces) {
  const PolygonMesh coloured = parse_mesh(corpus("off/binary_all_columns.off"), MeshFormat::off);
  EXPECT_EQ(coloured.colours, coloured.V);  // as the file was made
  const PolygonMesh mesh = parse_mesh(corpus("off/binary_face_colours.off"), MeshFormat::off);
  EXPECT_EQ(mesh.corners, (std::vector<int>{0, 1, 2, 3, 0, 1, 2}));
}

TEST(Vtk, StripsAreOrientedTriangles) {
  const PolygonMesh mesh = parse_mesh(corpus("vtk/strip.vtk"), MeshFormat::vtk);
  EXPECT_EQ(mesh.corners, (std::vector<int>{0, 1, 2, 2, 1, 3}));
}

class ComesBack : public testing::TestWithParam<MeshFormat> {};

TEST_P(ComesBack, WithTheSameFacesAndTheSamePositionsInSinglePrecision) {
  Mesh mesh = sample_mesh({SampleShape::figure, 2000});
  mesh.V = mesh.V.cast<float>().cast<double>().eval();
  const Mesh read = to_triangle_mesh(parse_mesh(serialize_mesh(mesh, GetParam()), GetParam()));
  EXPECT_EQ(read.V, mesh.V);
  EXPECT_EQ(read.F, mesh.F);
  EXPECT_EQ(serialize_mesh(read, GetParam()), serialize_mesh(mesh, GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Formats, ComesBack,
                         testing::Values(MeshFormat::gifti, MeshFormat::freesurfer, MeshFormat::vtk,
                                         MeshFormat::vtp, MeshFormat::gltf, MeshFormat::glb));

class KeepsDoublesAndPolygons : public testing::TestWithParam<MeshFormat> {};

TEST_P(KeepsDoublesAndPolygons, OfAnyMesh) {
  PolygonMesh mesh;
  mesh.V.resize(4, 3);
  mesh.V << 0.1, 0, 0, 1.0 / 3, 1e-300, 0, 1, 1, 0, 0, 1, 0;
  mesh.corners = {0, 1, 2, 3};
  mesh.face_start = {0, 4};
  const PolygonMesh read = parse_mesh(serialize_mesh(mesh, GetParam()), GetParam());
  EXPECT_EQ(read.V, mesh.V);
  EXPECT_EQ(read.corners, mesh.corners);
}

INSTANTIATE_TEST_SUITE_P(Vtk, KeepsDoublesAndPolygons, testing::Values(MeshFormat::vtk, MeshFormat::vtp));

TEST(Gifti, KnowsLabelsNamesAndTransforms) {
  std::string text = corpus("gifti/text.gii");
  const auto put = [&](const std::string& before, const std::string& inserted) {
    text.insert(text.find(before), inserted);
  };
  text.replace(text.find("<LabelTable/>"), 13,
               "<LabelTable><Label Key=\"7\"><![CDATA[insula]]></Label></LabelTable>");
  put("<Data>",
      "<MetaData><MD><Name>Name</Name><Value><![CDATA[mid]]></Value></MD></MetaData>"
      "<CoordinateSystemTransformMatrix><MatrixData>1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1</MatrixData>"
      "</CoordinateSystemTransformMatrix>");
  const GiftiFile file = read_gifti_file(text);
  ASSERT_EQ(file.labels.size(), 1U);
  EXPECT_EQ(file.labels[0].key, 7);
  EXPECT_EQ(file.labels[0].name, "insula");
  EXPECT_EQ(file.arrays[0].name, "mid");
  EXPECT_TRUE(file.arrays[0].has_transform);
  EXPECT_FALSE(file.arrays[1].has_transform);
  EXPECT_EQ(parse_mesh(text, MeshFormat::gifti).warnings.size(), 1U);
}

RC_GTEST_PROP(Base64, ComesBack, (const std::string& bytes)) {
  RC_ASSERT(from_base64(base64(bytes)) == bytes);
}

RC_GTEST_PROP(Compression, ComesBack, (const std::string& bytes)) {
  RC_ASSERT(decompress(compress(bytes)) == bytes);
  RC_ASSERT(decompress(compress_to_gzip(bytes)) == bytes);
  RC_ASSERT(decompress(compress(bytes), bytes.size()) == bytes);
  RC_ASSERT(decompress(compress_to_gzip(bytes) + compress_to_gzip(bytes)) == bytes + bytes);
}

RC_GTEST_PROP(Compression, TellsCutAndWrongSizes, (const std::string& bytes)) {
  const std::string packed = compress(bytes);
  RC_ASSERT_THROWS_AS(decompress(packed.substr(0, packed.size() - 1)), MeshError);
  RC_ASSERT_THROWS_AS(decompress(packed, bytes.size() + 1), MeshError);
  if (!bytes.empty()) RC_ASSERT_THROWS_AS(decompress(packed, bytes.size() - 1), MeshError);
}

TEST(Compression, ReadsAndWritesMeshFiles) {
  const fs::path folder = fs::temp_directory_path() / ("orbitutte_gz_" + std::to_string(::getpid()));
  fs::create_directory(folder);
  const std::string path = (folder / "figure.off.gz").string();
  const Mesh mesh = sample_mesh({SampleShape::figure, 2000});
  write_mesh(path, mesh);
  EXPECT_LT(fs::file_size(path), serialize_mesh(mesh, MeshFormat::off).size());
  EXPECT_EQ(to_triangle_mesh(read_mesh(path)).V, mesh.V);
  fs::remove_all(folder);
  EXPECT_EQ(mesh_format("LH.Surf.GII.gz"), MeshFormat::gifti);
  EXPECT_EQ(mesh_format("folder.x/lh.pial"), MeshFormat::freesurfer);
  EXPECT_THROW(mesh_format("x.gz"), ArgumentError);
  EXPECT_THROW(mesh_format("pial"), ArgumentError);
}

}  // namespace
}  // namespace orbitutte::brain_formats_test
