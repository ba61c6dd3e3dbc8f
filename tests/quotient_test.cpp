// SPDX-License-Identifier: MIT
// Maps to the whole sphere and to the hemisphere, which are quotients of maps to orbifolds.
#include "orbitutte/quotient/quotient.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "orbitutte/export/tiling.h"
#include "orbitutte/map/alignment.h"
#include "orbitutte/map/point_map.h"
#include "orbitutte/orbifold/exact_positions.h"
#include "orbitutte/quotient/centring.h"
#include "orbitutte/report/embedding_file.h"
#include "orbitutte/report/verification.h"
#include "sample_embeddings.h"

namespace orbitutte {
namespace {

using std::numbers::pi;
using testing::Contains;
using testing::Field;
using testing::HasSubstr;

Vector3 random_unit(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Vector3(normal(random), normal(random), normal(random)).normalized();
}

EmbedOptions quiet_options() {
  EmbedOptions options;
  options.threads = 1;
  return options;
}

Mesh sphere_mesh() { return test::sample_mesh_for(parse_orbifold("1")); }
Mesh disk_mesh() { return test::sample_mesh_for(parse_orbifold("*")); }

// An ellipsoid with a bump: a sphere whose images are not spread evenly by themselves.
Mesh uneven_sphere(int level) {
  Mesh mesh = test::icosphere(level);
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    const Vector3 p = mesh.V.row(v);
    mesh.V.row(v) = Vector3(2 * p.x(), p.y(), 0.7 * p.z()) *
                    (1 + 0.6 * std::exp(-8 * (p - Vector3::UnitX()).squaredNorm()));
  }
  return mesh;
}

EmbedResult embed_whole(const Mesh& mesh, const std::string& signature,
                        const EmbedOptions& options = quiet_options()) {
  return embed(mesh, parse_orbifold(signature), {}, options);
}

std::vector<std::string> failures(const Surface& surface, const Embedding& embedding) {
  std::vector<std::string> names;
  for (const Check& check : certify(surface, embedding).checks)
    if (!check.passed) names.push_back(check.name);
  return names;
}

// Moebius

TEST(Moebius, TheChartPointOfAUnitVectorLiesThere) {
  std::mt19937 random(1);
  for (int k = 0; k < 50; ++k) {
    const Vector3 p = random_unit(random);
    EXPECT_LT((sphere_point(chart_point_of(p)) - p).norm(), 1e-14);
  }
  for (const Vector3& pole : {Vector3(0, 0, 1), Vector3(0, 0, -1)})
    EXPECT_EQ(sphere_point(chart_point_of(pole)), pole);
}

TEST(Moebius, ABoostKeepsItsEndsAndMovesHeightsAsItSays) {
  std::mt19937 random(2);
  for (int k = 0; k < 50; ++k) {
    const Vector3 u = random_unit(random), p = random_unit(random);
    const double t = 0.1 * k, h = p.dot(u), tanh = std::tanh(t);
    const Moebius boost = Moebius::boost(t * u);
    const Vector3 image = sphere_point(boost(chart_point_of(p)));
    EXPECT_NEAR(image.dot(u), (h + tanh) / (1 + h * tanh), 1e-13);
    EXPECT_NEAR(u.cross(p).dot(image), 0, 1e-13);  // on the meridian
    EXPECT_LT((sphere_point(boost(chart_point_of(u))) - u).norm(), 1e-13);
  }
}

TEST(Moebius, ARotationIsItsMatrix) {
  std::mt19937 random(3);
  for (int k = 0; k < 50; ++k) {
    const Matrix3 R = Eigen::AngleAxisd(0.13 * k, random_unit(random)).toRotationMatrix();
    const Vector3 p = random_unit(random);
    EXPECT_LT((sphere_point(Moebius::rotation(R)(chart_point_of(p))) - R * p).norm(), 1e-13);
  }
}

TEST(Moebius, TakesThreePointsToThreeOthers) {
  std::mt19937 random(4);
  for (int k = 0; k < 50; ++k) {
    std::array<ChartPoint, 3> from, to;
    for (auto* points : {&from, &to})
      for (ChartPoint& point : *points) point = chart_point_of(random_unit(random));
    const Moebius moebius = Moebius::through(from, to);
    for (int i = 0; i < 3; ++i)
      EXPECT_LT((sphere_point(moebius(from[i])) - sphere_point(to[i])).norm(), 1e-10);
  }
}

// The whole sphere and the hemisphere

TEST(Quotient, IsACertifiedMapOfDegreeOneWithoutConesOrSeams) {
  const EmbedResult result = embed_whole(sphere_mesh(), "1");
  EXPECT_TRUE(result.certificate.bijective);
  EXPECT_NEAR(result.certificate.signed_area, 4 * pi, 1e-9);
  EXPECT_TRUE(result.embedding.cones.empty());
  EXPECT_TRUE(result.embedding.seams.empty());
  EXPECT_EQ(result.embedding.positions.rows(), test::vertex_count(sphere_mesh()));
  ASSERT_TRUE(result.quotient);
  EXPECT_EQ(result.quotient->signature, "222");
  EXPECT_EQ(result.quotient->centre, Centre::area);
}

TEST(Quotient, OfADiskIsAHemisphereWhoseMirrorIsTheBoundary) {
  const EmbedResult result = embed_whole(disk_mesh(), "*");
  EXPECT_TRUE(result.certificate.bijective);
  EXPECT_NEAR(result.certificate.signed_area, 2 * pi, 1e-9);
  ASSERT_EQ(result.embedding.seams.size(), 1U);
  EXPECT_TRUE(result.embedding.seams[0].is_mirror());
  EXPECT_GE(result.embedding.positions.col(2).minCoeff(), -1e-14);
  for (const int v : result.embedding.seams[0].left) EXPECT_NEAR(result.embedding.positions(v, 2), 0, 1e-15);
  EXPECT_EQ(result.embedding.seams[0].left.front(), result.embedding.seams[0].left.back());
}

TEST(Quotient, OfASolvedMapIsTheOneThatEmbedsAsksFor) {
  const Surface surface = make_surface(sphere_mesh());
  EmbedOptions options = quiet_options();
  const Target target = parse_orbifold("33");
  const std::vector<int> cones = choose_cones(surface, target);
  const EmbedResult map = embed(surface, target, cones, options);
  options.quotient.is_wanted = true;
  const EmbedResult direct = embed(surface, target, cones, options),
                    later = quotient_of(surface, map, options);
  EXPECT_TRUE(later.certificate.bijective);
  EXPECT_EQ(later.quotient->signature, "33");
  EXPECT_EQ(later.embedding.positions, direct.embedding.positions);
  const Target other = parse_orbifold("332");
  const EmbedResult without = embed(surface, other, choose_cones(surface, other), quiet_options());
  EXPECT_THROW(quotient_of(surface, without, options), ArgumentError);
}

TEST(Quotient, NamesOfTheWholeSphereAreItsSymbols) {
  EXPECT_EQ(parse_orbifold("sphere").signature, "1");
  EXPECT_EQ(parse_orbifold("hemisphere").signature, "*");
  EXPECT_EQ(parse_orbifold("1*").signature, "*");
  EXPECT_EQ(parse_orbifold("1").group_order, 1);
  EXPECT_EQ(parse_orbifold("*").group_order, 2);
  EXPECT_TRUE(parse_orbifold("1").is_free_to_rotate);
}

TEST(Quotient, AreaAndVerticesAreCentredToRounding) {
  for (const char* signature : {"1", "*"}) {
    const Mesh mesh = signature[0] == '1' ? uneven_sphere(3) : disk_mesh();
    for (const Centre centre : {Centre::area, Centre::vertices}) {
      EmbedOptions options = quiet_options();
      options.quotient.centre = centre;
      const EmbedResult result = embed_whole(mesh, signature, options);
      EXPECT_TRUE(result.certificate.bijective);
      EXPECT_LT(distance_from_centre(make_surface(mesh), centre, result.embedding), 1e-12);
      const Centre other = centre == Centre::area ? Centre::vertices : Centre::area;
      EXPECT_GT(distance_from_centre(make_surface(mesh), other, result.embedding), 1e-4);
    }
  }
}

TEST(Quotient, NoOtherMoebiusMapHasLessSigma) {
  const Mesh mesh = uneven_sphere(3);
  const Surface surface = make_surface(mesh);
  EmbedOptions options = quiet_options();
  options.quotient.centre = Centre::sigma;
  const EmbedResult result = embed_whole(mesh, "1", options);
  for (const Vector3& axis : {Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1)}) {
    for (const double t : {-0.1, 0.1}) {
      Embedding moved = result.embedding;
      for (Eigen::Index v = 0; v < moved.positions.rows(); ++v)
        moved.positions.row(v) =
            sphere_point(Moebius::boost(t * axis)(chart_point_of(moved.positions.row(v))));
      EXPECT_GT(measure_distortion(surface, moved).sigma, result.distortion.sigma);
    }
  }
}

// The largest distance between two maps of one mesh, the first rotated to meet the second.
double distance_up_to_rotation(const Embedding& one, const Embedding& other) {
  const Isometry R = best_rotation(one.target, one.positions, other.positions);
  return (R.on_rows(one.positions) - other.positions).rowwise().norm().maxCoeff();
}

double distance_between_base_cones(int level) {
  const Mesh mesh = uneven_sphere(level);
  const Surface surface = make_surface(mesh);
  const Target onto = parse_orbifold("1");
  std::vector<Embedding> maps;
  for (const std::vector<int>& cones : {std::vector<int>{0, 3, 8}, std::vector<int>{1, 6, 11}}) {
    const EmbedResult base = embed(surface, parse_orbifold("222"), cones, quiet_options());
    EXPECT_TRUE(base.certificate.bijective);
    Embedding& map = maps.emplace_back();
    map.target = onto;
    map.positions = QuotientMap(surface, base.embedding, onto, {}).positions();
  }
  return distance_up_to_rotation(maps[0], maps[1]);
}

TEST(Quotient, DoesNotDependOnTheConesOfTheMapThatItIsMadeFromAsTheMeshIsRefined) {
  const double coarse = distance_between_base_cones(3), fine = distance_between_base_cones(4);
  EXPECT_LT(fine, 0.02);
  EXPECT_LT(fine, 0.55 * coarse);
}

TEST(Quotient, OfASphereIsARotationUpToTheMeshsCoarseness) {
  const Mesh mesh = test::icosphere(4);
  const EmbedResult result = embed_whole(mesh, "1");
  Embedding itself = result.embedding;
  itself.positions = mesh.V;
  EXPECT_LT(distance_up_to_rotation(result.embedding, itself), 0.01);
}

TEST(Quotient, RotationsBetweenMapsToTheWholeSphereAreFound) {
  const EmbedResult result = embed_whole(sphere_mesh(), "1");
  std::mt19937 random(5);
  const Matrix3 R = Eigen::AngleAxisd(2.5, random_unit(random)).toRotationMatrix();
  const Points turned = result.embedding.positions * R.transpose();
  EXPECT_LT((best_rotation(result.embedding.target, result.embedding.positions, turned).matrix() - R).norm(),
            1e-12);
  const Points on_a_line = Vector3(1, 2, 3).normalized().transpose().replicate(4, 1);
  EXPECT_THROW(best_rotation(result.embedding.target, on_a_line, on_a_line), ArgumentError);
}

// Vertices at given points

TEST(Quotient, OneVertexOrThreeComeToLieAtGivenPoints) {
  const Mesh mesh = sphere_mesh();
  EmbedOptions options = quiet_options();
  options.quotient.points = {{5, Vector3(0.6, 0, 0.8)}};
  EmbedResult result = embed_whole(mesh, "1", options);
  EXPECT_TRUE(result.certificate.bijective);
  EXPECT_LT((result.embedding.positions.row(5) - Vector3(0.6, 0, 0.8).transpose()).norm(), 1e-14);
  EXPECT_LT(distance_from_centre(make_surface(mesh), Centre::area, result.embedding), 1e-12);

  options.quotient.points = {{0, Vector3::UnitX()}, {40, Vector3::UnitY()}, {90, Vector3::UnitZ()}};
  result = embed_whole(mesh, "1", options);
  EXPECT_TRUE(result.certificate.bijective);
  for (const PolygonCorner& at : options.quotient.points)
    EXPECT_LT((result.embedding.positions.row(at.vertex) - at.position.transpose()).norm(), 1e-14);
}

TEST(Quotient, VerticesOfADisksBoundaryComeToLieAtGivenPointsOfTheEquator) {
  const Mesh mesh = disk_mesh();
  const std::vector<int> loop = embed_whole(mesh, "*").embedding.seams[0].left;
  EmbedOptions options = quiet_options();
  options.quotient.points = {
      {loop[0], Vector3(1, 0, 0)}, {loop[5], Vector3(0, 1, 0)}, {loop[11], Vector3(-1, 0, 0)}};
  const EmbedResult result = embed_whole(mesh, "*", options);
  EXPECT_TRUE(result.certificate.bijective);
  for (const PolygonCorner& at : options.quotient.points)
    EXPECT_LT((result.embedding.positions.row(at.vertex) - at.position.transpose()).norm(), 1e-14);
  std::swap(options.quotient.points[0].position, options.quotient.points[1].position);
  EXPECT_THROW(embed_whole(mesh, "*", options), ArgumentError);
}

std::string refusal(const Mesh& mesh, const std::string& signature, const EmbedOptions& options) {
  try {
    embed_whole(mesh, signature, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Quotient, PointsThatMeanNothingAreRefused) {
  EmbedOptions options = quiet_options();
  options.quotient.points = {
      {0, Vector3::UnitX()}, {1, Vector3::UnitY()}, {2, Vector3::UnitZ()}, {3, -Vector3::UnitZ()}};
  EXPECT_THAT(refusal(sphere_mesh(), "1", options), HasSubstr("three decide the map"));
  options.quotient.points = {{-1, Vector3::UnitX()}};
  EXPECT_THAT(refusal(sphere_mesh(), "1", options), HasSubstr("vertex -1 is to lie at a given point"));
  options.quotient.points = {{0, Vector3(0, 0, 2)}};
  EXPECT_THAT(refusal(sphere_mesh(), "1", options), HasSubstr("vertex 0 is not on the unit sphere"));
  options.quotient.points = {{0, Vector3::UnitX()}, {0, Vector3::UnitY()}, {4, Vector3::UnitZ()}};
  EXPECT_THAT(refusal(sphere_mesh(), "1", options), HasSubstr("the vertices 0 and 0"));
  options.quotient.points = {{0, Vector3::UnitX()}};  // the middle of the disk
  EXPECT_THAT(refusal(disk_mesh(), "*", options), HasSubstr("vertex 0 is inside the disk"));
}

TEST(Quotient, TwoVerticesComeToLieAtGivenPointsAndTheRestIsBalancedBetweenThem) {
  const Mesh mesh = uneven_sphere(3);
  const Surface surface = make_surface(mesh);
  EmbedOptions options = quiet_options();
  for (const Vector3& second : {Vector3(-Vector3::UnitX()), Vector3(0, 0.6, 0.8)}) {
    options.quotient.points = {{3, Vector3::UnitX()}, {50, second}};
    const EmbedResult result = embed_whole(mesh, "1", options);
    EXPECT_TRUE(result.certificate.bijective);
    for (const PolygonCorner& at : options.quotient.points)
      EXPECT_LT((result.embedding.positions.row(at.vertex) - at.position.transpose()).norm(), 1e-13);
    if (second.x() < 0) {
      const Eigen::VectorXd shares = vertex_shares(surface, Centre::area);
      EXPECT_NEAR(result.embedding.positions.col(0).dot(shares), 0, 1e-12);
    }
  }
  const Mesh disk = disk_mesh();
  const std::vector<int> loop = embed_whole(disk, "*").embedding.seams[0].left;
  options.quotient.points = {{loop[2], Vector3::UnitX()}, {loop[9], Vector3(-0.6, 0.8, 0)}};
  const EmbedResult half = embed_whole(disk, "*", options);
  EXPECT_TRUE(half.certificate.bijective);
  for (const PolygonCorner& at : options.quotient.points)
    EXPECT_LT((half.embedding.positions.row(at.vertex) - at.position.transpose()).norm(), 1e-13);
}

// Quotients of other maps

TEST(Quotient, OfMapsToNNHasTheMarkedVerticesAtThePoles) {
  const Mesh mesh = sphere_mesh();
  EmbedOptions options = quiet_options();
  options.quotient.is_wanted = true;
  for (const char* signature : {"22", "33", "55"}) {
    const Target target = parse_orbifold(signature);
    const std::vector<int> cones = choose_cones(mesh, target);
    const EmbedResult result = embed(mesh, target, cones, options);
    EXPECT_TRUE(result.certificate.bijective) << signature;
    EXPECT_EQ(result.embedding.target.signature, "1");
    EXPECT_NEAR(result.certificate.signed_area, 4 * pi, 1e-9);
    EXPECT_NEAR(result.embedding.positions(cones[0], 2), 1, 1e-12);
    EXPECT_NEAR(result.embedding.positions(cones[1], 2), -1, 1e-12);
    EXPECT_EQ(result.quotient->signature, signature);
  }
}

TEST(Quotient, OfMapsOfDisksIsAHemisphere) {
  const Mesh mesh = disk_mesh();
  EmbedOptions options = quiet_options();
  options.quotient.is_wanted = true;
  for (const char* signature : {"*222", "*22", "*33", "2*", "5*"}) {
    const Target target = parse_orbifold(signature);
    const EmbedResult result = embed(mesh, target, choose_cones(mesh, target), options);
    EXPECT_TRUE(result.certificate.bijective) << signature;
    EXPECT_EQ(result.embedding.target.signature, "*");
    EXPECT_NEAR(result.certificate.signed_area, 2 * pi, 1e-9);
  }
}

TEST(Quotient, IsRefusedWhereItIsNotKnown) {
  const Mesh mesh = sphere_mesh();
  EmbedOptions options = quiet_options();
  options.quotient.is_wanted = true;
  const Target target = parse_orbifold("432");
  EXPECT_THROW(embed(mesh, target, choose_cones(mesh, target), options), ArgumentError);
  options.quotient = {false, Centre::area, {}};
  EXPECT_THROW(embed(mesh, target, choose_cones(mesh, target), options), ArgumentError);
}

// What is done with the result

TEST(Quotient, TheTilingIsTheMapItselfOrTwoCopiesOfTheHemisphere) {
  const EmbedResult sphere = embed_whole(sphere_mesh(), "1"), disk = embed_whole(disk_mesh(), "*");
  const Tiling one = weld_copies(sphere.embedding), two = weld_copies(disk.embedding);
  EXPECT_EQ(one.copy_count(), 1);
  EXPECT_EQ(one.mesh.F, sphere.embedding.triangles);
  EXPECT_LT((one.mesh.V - sphere.embedding.positions).norm(), 1e-14);
  EXPECT_EQ(two.copy_count(), 2);
  EXPECT_TRUE(two.copies[1].mirrored);
  EXPECT_EQ(2 * two.mesh.V.rows(), two.mesh.F.rows() + 4);
}

TEST(Quotient, EveryVertexIsLocatedWhereItLies) {
  const EmbedResult result = embed_whole(sphere_mesh(), "1");
  const SurfacePoints found = PointLocator(result.embedding).locate(result.embedding.positions);
  for (int v = 0; v < found.count(); ++v) {
    ASSERT_GE(found.triangle[v], 0);
    const auto corners = result.embedding.triangles.row(found.triangle[v]);
    EXPECT_EQ(std::count(corners.begin(), corners.end(), v), 1);
  }
}

TEST(Quotient, IsVerifiedFromItsFilesAlone) {
  for (const char* signature : {"1", "*"}) {
    const Mesh mesh = signature[0] == '1' ? sphere_mesh() : disk_mesh();
    const EmbedResult result = embed_whole(mesh, signature);
    const Report report = parse_report(report_json(result, {}));
    ASSERT_TRUE(report.quotient);
    const Embedding read = with_report(parse_embedding(serialize_embedding(result.embedding)), report);
    VerificationOptions options;
    options.theorem2 = true;
    const Surface surface = make_surface(mesh);
    const Verdict verdict = verify(surface, read, report, options);
    EXPECT_TRUE(verdict.bijective);
    EXPECT_THAT(verdict.theorem2->detail, HasSubstr("quotient"));

    Embedding moved = read;  // as a whole: still a bijection, but not where the report says
    for (Eigen::Index v = 0; v < moved.positions.rows(); ++v)
      moved.positions.row(v) =
          sphere_point(Moebius::boost(Vector3(1e-6, 0, 0))(chart_point_of(moved.positions.row(v))));
    const Verdict other = verify(surface, moved, report);
    EXPECT_FALSE(other.bijective);
    EXPECT_THAT(other.checks,
                Contains(testing::AllOf(Field(&Check::name, "report_centre"), Field(&Check::passed, false))));
  }
}

// Planted faults

TEST(Quotient, AFoldedFaceIsSeen) {
  const Surface surface = make_surface(sphere_mesh());
  Embedding folded = embed_whole(sphere_mesh(), "1").embedding;
  const auto corners = folded.triangles.row(17);
  const Vector3 a = folded.positions.row(corners[0]), b = folded.positions.row(corners[1]),
                c = folded.positions.row(corners[2]);
  folded.positions.row(corners[0]) = (a - 3 * (a - (b + c) / 2)).normalized().transpose();
  EXPECT_THAT(failures(surface, folded), Contains("positive_faces"));
}

TEST(Quotient, AMapOfDegreeTwoIsSeen) {
  const Surface surface = make_surface(test::icosphere(4));
  Embedding twice = embed_whole(test::icosphere(4), "1").embedding;
  for (Eigen::Index v = 0; v < twice.positions.rows(); ++v) {
    const ChartPoint z = chart_point_of(twice.positions.row(v));
    twice.positions.row(v) =
        sphere_point({z.numerator * z.numerator, z.denominator * z.denominator, nullptr}).transpose();
  }
  EXPECT_THAT(failures(surface, twice), Contains("signed_area"));
}

TEST(Quotient, AMirroredMapIsSeen) {
  const Surface surface = make_surface(sphere_mesh());
  Embedding mirrored = embed_whole(sphere_mesh(), "1").embedding;
  mirrored.positions.col(0) *= -1;
  EXPECT_THAT(failures(surface, mirrored), Contains("positive_faces"));
}

TEST(Quotient, AnOrbifoldMapThatCallsItselfWholeIsSeen) {
  const test::SampleEmbedding& sample = test::sample_embedding("222");
  Embedding claimed = sample.embedding();
  claimed.target = parse_orbifold("1");
  claimed.cones.clear();
  claimed.seams.clear();
  EXPECT_THAT(failures(make_surface(sample.mesh), claimed), Contains("seam_gluing"));
}

TEST(Quotient, AHemisphereWithoutItsMirrorOrOffItIsSeen) {
  const Surface surface = make_surface(disk_mesh());
  const Embedding embedding = embed_whole(disk_mesh(), "*").embedding;
  Embedding open = embedding;
  open.seams.clear();
  EXPECT_THAT(failures(surface, open), Contains("seam_gluing"));
  Embedding off = embedding;
  const int v = off.seams[0].left[3];
  off.positions.row(v) = (Vector3(off.positions.row(v)) + Vector3(0, 0, 1e-4)).normalized().transpose();
  EXPECT_THAT(failures(surface, off), Contains("seam_residual"));
}

}  // namespace
}  // namespace orbitutte
