// SPDX-License-Identifier: MIT
#include "orbitutte/io/ply_triangles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

namespace orbitutte::ply_triangles_test {
namespace {

using testing::ElementsAre;
using testing::Optional;

/// A mesh whose vertices carry integers, any of them.
struct Numbered {
  Points V;
  Triangles F;
  std::vector<int> numbers, others;

  std::vector<PlyIntegers> properties() const { return {{"number", numbers}, {"other", others}}; }
};

Numbered random_numbered() {
  const auto bits = *rc::gen::container<std::vector<std::uint64_t>>(rc::gen::arbitrary<std::uint64_t>());
  const auto corners = *rc::gen::container<std::vector<int>>(rc::gen::arbitrary<int>());
  const Eigen::Index n = static_cast<Eigen::Index>(bits.size()) / 3;
  Numbered mesh = {Points(n, 3), Triangles(corners.size() / 3, 3), {}, {}};
  for (Eigen::Index i = 0; i < mesh.V.size(); ++i) mesh.V.data()[i] = std::bit_cast<double>(bits[i]);
  for (Eigen::Index i = 0; i < mesh.F.size(); ++i) mesh.F.data()[i] = corners[i];
  for (std::vector<int>* values : {&mesh.numbers, &mesh.others})
    *values = *rc::gen::container<std::vector<int>>(n, rc::gen::arbitrary<int>());
  return mesh;
}

template <class Values>
PlyProperty property(const std::string& name, PlyType type, const Values& values) {
  PlyProperty result;
  result.name = name;
  result.type = type;
  result.values.assign(values.begin(), values.end());
  return result;
}

PlyFile as_ply_file(const Numbered& mesh, const std::vector<std::string>& comments) {
  PlyElement vertex = {"vertex", mesh.numbers.size(), {}};
  for (int k = 0; k < 3; ++k) {
    const Eigen::VectorXd column = mesh.V.col(k);
    vertex.properties.push_back(property(std::string(1, "xyz"[k]), PlyType::float64, column));
  }
  vertex.properties.push_back(property("number", PlyType::int32, mesh.numbers));
  vertex.properties.push_back(property("other", PlyType::int32, mesh.others));
  PlyProperty list = property("vertex_indices", PlyType::int32, mesh.F.reshaped<Eigen::RowMajor>());
  list.is_list = true;
  const auto faces = static_cast<std::size_t>(mesh.F.rows());
  for (std::size_t f = 0; f <= faces; ++f) list.list_start.push_back(3 * f);
  return {comments, {vertex, {"face", faces, {list}}}};
}

RC_GTEST_PROP(PlyTriangles, AreTheBytesOfTheGeneralWriter, ()) {
  const Numbered mesh = random_numbered();
  const std::vector<std::string> comments = {"one", "two\nlines"};
  RC_ASSERT(write_ply_triangles(mesh.V, mesh.F, mesh.properties(), comments) ==
            serialize_ply(as_ply_file(mesh, comments)));
}

RC_GTEST_PROP(PlyTriangles, IntegersComeBackByTheirNames, ()) {
  const Numbered mesh = random_numbered();
  const std::string bytes = write_ply_triangles(mesh.V, mesh.F, mesh.properties());
  const PlyHeader header = parse_ply_header(bytes);
  RC_ASSERT(read_ply_integers(bytes, header, "number") == mesh.numbers);
  RC_ASSERT(read_ply_integers(bytes, header, "other") == mesh.others);
  RC_ASSERT(read_ply_integers(bytes, header, "neither") == std::nullopt);
  RC_ASSERT(read_ply_integers(bytes, header, "x") == std::nullopt);
}

TEST(PlyTriangles, IntegersAreReadInTheByteOrderOfTheFile) {
  const std::string header_text =
      "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty int number\nproperty float x\n"
      "property float y\nproperty float z\nelement face 0\nproperty list uchar int vertex_indices\n"
      "end_header\n";
  const std::string bytes = header_text + std::string("\1\2\3\4", 4) + std::string(12, '\0');
  EXPECT_THAT(read_ply_integers(bytes, parse_ply_header(bytes), "number"), Optional(ElementsAre(0x01020304)));
}

TEST(PlyTriangles, OtherLayoutsHaveNoIntegers) {
  const std::string bytes =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty int number\nproperty float x\n"
      "property float y\nproperty float z\nelement face 0\nproperty list uchar int vertex_indices\n"
      "end_header\n7 0 0 0\n";
  EXPECT_EQ(read_ply_integers(bytes, parse_ply_header(bytes), "number"), std::nullopt);
}

TEST(PlyTriangles, EveryVertexNeedsItsInteger) {
  const Points V = Points::Zero(3, 3);
  for (const std::vector<int>& numbers : {std::vector<int>{}, {1, 2}, {1, 2, 3, 4}})
    EXPECT_THROW(write_ply_triangles(V, Triangles(0, 3), {{"number", numbers}}), ArgumentError);
}

}  // namespace
}  // namespace orbitutte::ply_triangles_test
