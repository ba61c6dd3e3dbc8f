// SPDX-License-Identifier: MIT
// I. Wald et al., "Embree: A Kernel Framework for Efficient CPU Ray Tracing", ACM TOG 33(4), 2014.
#include "orbitutte/render/ray_scene.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <fmt/format.h>

#include <array>
#include <new>

namespace orbitutte {
namespace {

/// One device for the process, never released: Embree's threads may outlive the program's statics.
RTCDevice device() {
  static RTCDevice shared = rtcNewDevice("verbose=0");
  if (!shared) throw Error("Embree does not start");
  return shared;
}

void check_device() {
  const RTCError error = rtcGetDeviceError(device());
  if (error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  throw Error(fmt::format("Embree fails with error {}", static_cast<int>(error)));
}

RTCGeometry new_geometry(RTCGeometryType type) {
  const RTCGeometry geometry = rtcNewGeometry(device(), type);
  if (!geometry) check_device();
  return geometry;
}

// `count` elements of T, to be filled in.
template <typename T>
T* new_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, Eigen::Index count) {
  void* const buffer =
      rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), static_cast<std::size_t>(count));
  if (!buffer) check_device();
  return static_cast<T*>(buffer);
}

struct Thick {
  float x, y, z, radius;
};

Thick* new_thick_points(RTCGeometry geometry, Eigen::Index count) {
  return new_buffer<Thick>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, count);
}

Thick thick(const Vector3& p, double radius) {
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]),
          static_cast<float>(radius)};
}

int attach(RTCScene scene, RTCGeometry geometry) {
  rtcCommitGeometry(geometry);
  const unsigned shape = rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  check_device();
  return static_cast<int>(shape);
}

RTCRay to_rtc(const Ray& ray) {
  RTCRay result = {};
  result.org_x = ray.origin[0], result.org_y = ray.origin[1], result.org_z = ray.origin[2];
  result.dir_x = ray.direction[0], result.dir_y = ray.direction[1], result.dir_z = ray.direction[2];
  result.tfar = ray.length;
  result.mask = ~0U;
  return result;
}

// For each ray -1, or 0 if it is to be left out.
struct alignas(32) Valid {
  std::array<int, packet_size> rays;
};

Valid valid_of(const Packet& rays) {
  Valid valid;
  for (int k = 0; k < packet_size; ++k) valid.rays[k] = rays[k].length >= 0 ? -1 : 0;
  return valid;
}

RTCRay8 to_rtc(const Packet& rays) {
  RTCRay8 result;
  for (int k = 0; k < packet_size; ++k) {
    const Ray& ray = rays[k];
    result.org_x[k] = ray.origin[0], result.org_y[k] = ray.origin[1], result.org_z[k] = ray.origin[2];
    result.dir_x[k] = ray.direction[0], result.dir_y[k] = ray.direction[1];
    result.dir_z[k] = ray.direction[2];
    result.tnear[k] = 0, result.tfar[k] = ray.length, result.time[k] = 0;
    result.mask[k] = ~0U, result.id[k] = result.flags[k] = 0;
  }
  return result;
}

// The k-th hit of a packet.
RTCHit hit_in(const RTCHit8& hits, int k) {
  RTCHit hit = {};
  hit.Ng_x = hits.Ng_x[k], hit.Ng_y = hits.Ng_y[k], hit.Ng_z = hits.Ng_z[k];
  hit.u = hits.u[k], hit.v = hits.v[k];
  hit.primID = hits.primID[k], hit.geomID = hits.geomID[k], hit.instID[0] = hits.instID[0][k];
  return hit;
}

// In the shape's own coordinates.
Hit to_hit(float distance, const RTCHit& found) {
  Hit hit;
  hit.distance = distance;
  hit.shape = static_cast<int>(found.geomID);
  hit.primitive = static_cast<int>(found.primID);
  if (found.instID[0] != RTC_INVALID_GEOMETRY_ID) hit.copy = static_cast<int>(found.instID[0]);
  hit.u = found.u, hit.v = found.v;
  hit.normal = Vector3f(found.Ng_x, found.Ng_y, found.Ng_z).normalized();
  return hit;
}

// The calls whose signatures changed with Embree 4.
#if RTC_VERSION_MAJOR >= 4
void intersect(RTCScene scene, RTCRayHit& query) { rtcIntersect1(scene, &query); }
void occlude(RTCScene scene, RTCRay& query) { rtcOccluded1(scene, &query); }

void intersect(RTCScene scene, const Valid& valid, RTCRayHit8& query) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect8(valid.rays.data(), scene, &query, &arguments);
}

void occlude(RTCScene scene, const Valid& valid, RTCRay8& query) {
  rtcOccluded8(valid.rays.data(), scene, &query);
}
#else
RTCIntersectContext context_of(RTCIntersectContextFlags flags) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = flags;
  return context;
}

void intersect(RTCScene scene, RTCRayHit& query) {
  RTCIntersectContext context = context_of(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  rtcIntersect1(scene, &context, &query);
}

void occlude(RTCScene scene, RTCRay& query) {
  RTCIntersectContext context = context_of(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  rtcOccluded1(scene, &context, &query);
}

void intersect(RTCScene scene, const Valid& valid, RTCRayHit8& query) {
  RTCIntersectContext context = context_of(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
  rtcIntersect8(valid.rays.data(), scene, &context, &query);
}

void occlude(RTCScene scene, const Valid& valid, RTCRay8& query) {
  RTCIntersectContext context = context_of(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  rtcOccluded8(valid.rays.data(), scene, &context, &query);
}
#endif

}  // namespace

RayScene::RayScene() : scene_(rtcNewScene(device()), rtcReleaseScene) {
  // No ray slips through between two triangles.
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
}

int RayScene::add_triangles(const Points& V, const Triangles& F) {
  auto [P, pieces] = short_pieces(V, F);
  const RTCGeometry geometry = new_geometry(RTC_GEOMETRY_TYPE_TRIANGLE);
  using Position = std::array<float, 3>;
  auto* const positions = new_buffer<Position>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, P.rows());
  for (Eigen::Index v = 0; v < P.rows(); ++v)
    for (int k = 0; k < 3; ++k) positions[v][k] = static_cast<float>(P(v, k));
  using Corners = std::array<unsigned, 3>;
  auto* const corners = new_buffer<Corners>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3,
                                            static_cast<Eigen::Index>(pieces.size()));
  // Pieces may begin at another corner than their face; what is whole is hit in the face's own coordinates.
  const bool are_whole = static_cast<Eigen::Index>(pieces.size()) == F.rows();
  for (int f = 0; f < static_cast<int>(pieces.size()); ++f)
    for (int k = 0; k < 3; ++k)
      corners[f][k] = static_cast<unsigned>(are_whole ? F(f, k) : pieces[f].corners[k]);
  shapes_->push_back({are_whole ? std::vector<Piece>() : std::move(pieces)});
  return attach(scene_.get(), geometry);
}

int RayScene::add_tube(const Points& points, double radius) {
  const RTCGeometry geometry = new_geometry(RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
  Thick* const nodes = new_thick_points(geometry, points.rows());
  for (Eigen::Index i = 0; i < points.rows(); ++i) nodes[i] = thick(points.row(i), radius);
  auto* const segments =
      new_buffer<unsigned>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT, points.rows() - 1);
  for (Eigen::Index i = 0; i + 1 < points.rows(); ++i) segments[i] = static_cast<unsigned>(i);
  shapes_->emplace_back();
  return attach(scene_.get(), geometry);
}

int RayScene::add_ball(const Vector3& centre, double radius) {
  const RTCGeometry geometry = new_geometry(RTC_GEOMETRY_TYPE_SPHERE_POINT);
  *new_thick_points(geometry, 1) = thick(centre, radius);
  shapes_->emplace_back();
  return attach(scene_.get(), geometry);
}

int RayScene::add_copy(const RayScene& original, const Matrix3& transform) {
  const RTCGeometry geometry = new_geometry(RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, original.scene_.get());
  rtcSetGeometryTimeStepCount(geometry, 1);
  shapes_->push_back({{}, transform.cast<float>(), original.shapes_});
  Eigen::Matrix<float, 3, 4> affine = Eigen::Matrix<float, 3, 4>::Zero();
  affine.leftCols<3>() = shapes_->back().transform;
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, affine.data());
  return attach(scene_.get(), geometry);
}

void RayScene::commit() {
  rtcCommitScene(scene_.get());
  check_device();
}

Hit RayScene::in_its_shape(Hit hit) const {
  const std::vector<Shape>* shapes = shapes_.get();
  if (hit.copy >= 0) {
    const Shape& copy = (*shapes)[hit.copy];
    hit.normal = copy.transform * hit.normal;
    shapes = copy.original.get();
  }
  if (const std::vector<Piece>& pieces = (*shapes)[hit.shape].pieces; !pieces.empty()) {
    const Piece& piece = pieces[hit.primitive];
    const Eigen::Vector2f place = piece.place_in_face(hit.u, hit.v);
    hit.primitive = piece.face;
    hit.u = place[0], hit.v = place[1];
  }
  return hit;
}

std::optional<Hit> RayScene::first_hit(const Ray& ray) const {
  RTCRayHit query = {to_rtc(ray), {}};
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  intersect(scene_.get(), query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return in_its_shape(to_hit(query.ray.tfar, query.hit));
}

Hits RayScene::first_hits(const Packet& rays) const {
  if (shapes_->empty()) return {};
  RTCRayHit8 query = {to_rtc(rays), {}};
  for (int k = 0; k < packet_size; ++k)
    query.hit.geomID[k] = query.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
  intersect(scene_.get(), valid_of(rays), query);
  Hits hits;
  for (int k = 0; k < packet_size; ++k)
    if (query.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID)
      hits[k] = in_its_shape(to_hit(query.ray.tfar[k], hit_in(query.hit, k)));
  return hits;
}

bool RayScene::is_blocked(const Ray& ray) const {
  RTCRay query = to_rtc(ray);
  occlude(scene_.get(), query);
  return query.tfar < 0;
}

std::bitset<packet_size> RayScene::are_blocked(const Packet& rays) const {
  if (shapes_->empty()) return {};
  RTCRay8 query = to_rtc(rays);
  occlude(scene_.get(), valid_of(rays), query);
  std::bitset<packet_size> blocked;
  for (int k = 0; k < packet_size; ++k) blocked[k] = rays[k].length >= 0 && query.tfar[k] < 0;
  return blocked;
}

}  // namespace orbitutte
