// SPDX-License-Identifier: MIT
#include "orbitutte/solve/moduli_energy.h"

#include <Eigen/Geometry>
#include <cstdlib>
#include <map>
#include <utility>

#include "orbitutte/geometry/precise_isometry.h"
#include "orbitutte/geometry/space.h"
#include "orbitutte/orbifold/precise_generators.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

// The gradient of d(p, q)^2 by p: -2 d/sn d times the tangential part of q - p.
template <int k>
Vector3 gradient_of_squared_distance(Curvature<k> curvature, const Vector3& p, const Vector3& q) {
  return -2 * curvature.distance(p, q).over_sn * curvature.tangent(p, q - p);
}

Points positions_of(const VaryingMarks& marks) {
  Points result(static_cast<Eigen::Index>(marks.points().size()), 3);
  for (Eigen::Index k = 0; k < result.rows(); ++k) result.row(k) = marks.points()[k].position.transpose();
  return result;
}

}  // namespace

ModuliEnergy::ModuliEnergy(const Moduli& moduli, const EdgeWords& edges, Eigen::VectorXd w,
                           std::vector<int> cones)
    : moduli_(moduli), edges_(edges), w_(std::move(w)), cones_(std::move(cones)) {
  int vertices = 0;
  for (const auto& [i, j, t] : edges.edges) vertices = std::max({vertices, i + 1, j + 1});
  cone_at_.assign(vertices, -1);
  for (std::size_t k = 0; k < cones_.size(); ++k) cone_at_[cones_[k]] = static_cast<int>(k);
  list_beginnings();
  dependent_ = parallel_select(static_cast<int>(edges.edges.size()), [&](int e) {
    const auto& [i, j, t] = edges_.edges[e];
    return t != 0 || cone_at_[i] >= 0 || cone_at_[j] >= 0;
  });
}

void ModuliEnergy::list_beginnings() {
  std::map<std::pair<int, int>, int> numbers;
  beginnings_ = {{}};
  for (const GluingWord& word : edges_.words) {
    int at = 0;
    for (const int letter : word) {
      const auto [found, is_new] = numbers.try_emplace({at, letter}, static_cast<int>(beginnings_.size()));
      if (is_new) beginnings_.push_back({at, letter});
      at = found->second;
    }
    beginning_of_word_.push_back(at);
  }
}

std::vector<Isometry> ModuliEnergy::products(const Points& cones) const {
  const Space space = moduli_.space();
  const std::vector<Matrix3Of<Precise>> generators = precise_generators(space, moduli_.order(), cones);
  std::vector<Matrix3Of<Precise>> precise = {Matrix3Of<Precise>::Identity()};
  std::vector<Isometry> result = {Isometry()};
  for (std::size_t k = 1; k < beginnings_.size(); ++k) {
    const auto& [shorter, letter] = beginnings_[k];
    const Matrix3Of<Precise>& generator = generators[std::abs(letter) - 1];
    precise.push_back(precise[shorter] * (letter > 0 ? generator : precise_inverse(space, generator)));
    result.push_back(rounded_isometry(space, precise.back()));
  }
  return result;
}

std::vector<Isometry> ModuliEnergy::transforms(const Points& cones) const {
  const std::vector<Isometry> of_beginnings = products(cones);
  std::vector<Isometry> result;
  result.reserve(beginning_of_word_.size());
  for (const int k : beginning_of_word_) result.push_back(of_beginnings[k]);
  return result;
}

GluedEdges ModuliEnergy::glued(const Points& cones) const { return {edges_.edges, transforms(cones)}; }

Points ModuliEnergy::with_cones(Points x, const Points& cones) const {
  for (std::size_t k = 0; k < cones_.size(); ++k) x.row(cones_[k]) = cones.row(static_cast<Eigen::Index>(k));
  return x;
}

template <typename Visit>
void ModuliEnergy::for_each(const Points& x, const std::vector<Isometry>& transforms,
                            const Visit& visit) const {
  for (const int e : dependent_) {
    const GluedEdge& edge = edges_.edges[e];
    visit(edge, w_[e], Vector3(x.row(edge.i)), transforms[edge.t] * Vector3(x.row(edge.j)));
  }
}

double ModuliEnergy::energy(const Points& x, const Points& cones) const {
  const Points all = with_cones(x, cones);
  return visit_curvature(moduli_.space(), [&](auto curvature) {
    double sum = 0;
    for_each(all, transforms(cones), [&](const GluedEdge&, double w, const Vector3& p, const Vector3& q) {
      sum += w * curvature.distance(p, q).squared;
    });
    return sum;
  });
}

Points ModuliEnergy::gradient(const Points& x, const Points& cones) const {
  const Points all = with_cones(x, cones);
  const std::vector<Isometry> transform = transforms(cones);
  Points result = Points::Zero(x.rows(), 3);
  visit_curvature(moduli_.space(), [&](auto curvature) {
    for_each(all, transform, [&](const GluedEdge& edge, double w, const Vector3& p, const Vector3& q) {
      result.row(edge.i) += w * gradient_of_squared_distance(curvature, p, q);
      result.row(edge.j) +=
          w * (transform[edge.t].inverse_matrix() * gradient_of_squared_distance(curvature, q, p));
    });
  });
  for (const int v : cones_) result.row(v).setZero();
  lower_rows(moduli_.space(), result);
  return result;
}

std::vector<VaryingIsometry> ModuliEnergy::varying_transforms(const VaryingMarks& marks,
                                                              Eigen::Index parameters, Order order) const {
  const std::vector<VaryingIsometry> generators = marks.generators();
  const std::vector<Isometry> values = products(positions_of(marks));
  std::vector<VaryingIsometry> of_beginnings = {
      {Isometry(), VaryingMotion::none(moduli_.space(), parameters, order)}};
  for (std::size_t k = 1; k < beginnings_.size(); ++k) {
    const auto& [shorter, letter] = beginnings_[k];
    const VaryingIsometry& from = of_beginnings[shorter];
    const VaryingIsometry& generator = generators[std::abs(letter) - 1];
    const VaryingMotion motion = letter > 0 ? generator.motion : generator.inverse().motion;
    of_beginnings.push_back({values[k], from.motion * motion.seen_through(from.value)});
  }
  std::vector<VaryingIsometry> result;
  result.reserve(beginning_of_word_.size());
  for (const int k : beginning_of_word_) result.push_back(of_beginnings[k]);
  return result;
}

// Where q = g x_j moves by the infinitesimal isometry w, d^2 changes by <u, J (w x q)> = w . (q x u), u the
// gradient by q. So each g needs one sum of moments q x u.
Eigen::VectorXd ModuliEnergy::cone_gradient(const Points& x, const VaryingMarks& marks) const {
  const Points cones = positions_of(marks), all = with_cones(x, cones);
  const std::vector<VaryingIsometry> varying =
      varying_transforms(marks, marks.points().front().motion.parameters(), Order::first);
  std::vector<Isometry> transform;
  transform.reserve(varying.size());
  for (const VaryingIsometry& g : varying) transform.push_back(g.value);
  Eigen::Matrix3Xd moments = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(transform.size()));
  Points at_cones = Points::Zero(cones.rows(), 3);
  visit_curvature(moduli_.space(), [&](auto curvature) {
    for_each(all, transform, [&](const GluedEdge& edge, double w, const Vector3& p, const Vector3& q) {
      const Vector3 u = w * gradient_of_squared_distance(curvature, q, p);
      moments.col(edge.t) += q.cross(u);
      if (const int k = cone_at_[edge.i]; k >= 0)
        at_cones.row(k) += w * gradient_of_squared_distance(curvature, p, q);
      if (const int k = cone_at_[edge.j]; k >= 0) at_cones.row(k) += transform[edge.t].inverse_matrix() * u;
    });
  });
  Eigen::VectorXd result = Eigen::VectorXd::Zero(marks.points().front().motion.parameters());
  const Eigen::RowVector3d metric = moduli_.space().metric().transpose();
  for (Eigen::Index k = 0; k < cones.rows(); ++k)
    result += marks.points()[k].motion.velocities(cones.row(k)).transpose() *
              at_cones.row(k).cwiseProduct(metric).transpose();
  for (std::size_t t = 0; t < varying.size(); ++t)
    result += varying[t].motion.first.transpose() * moments.col(static_cast<Eigen::Index>(t));
  return result;
}

Eigen::VectorXd ModuliEnergy::cone_gradient(const Points& x, const Points& cones) const {
  return cone_gradient(x, moduli_.varying(cones));
}

VaryingMotion ModuliEnergy::motion_along(const GluedEdge& edge, const VaryingIsometry& transform,
                                         const VaryingMarks& marks) const {
  VaryingMotion motion = transform.motion;
  if (const int k = cone_at_[edge.j]; k >= 0)
    motion = motion * marks.points()[k].motion.seen_through(transform.value);
  if (const int k = cone_at_[edge.i]; k >= 0) motion = marks.points()[k].motion.inverse() * motion;
  return motion;
}

namespace {

// What moving an edge's far end q, as it is seen from the near end p, changes: with the squared chord s = <y,
// y>, y = q - p, and f(s) = d^2, of which f' = d/sn d.
class MovingEdge {
 public:
  MovingEdge(const VaryingMotion& motion, const Vector3& p, const Vector3& q)
      : motion_(motion), p_(p), q_(q), y_(q - p), velocity_(motion.velocities(q)) {
    const Space space = motion.space;
    s_ = space.dot(y_, y_);
    visit_curvature(space, [&](auto curvature) {
      slope_ = curvature.distance(p, q).over_sn;
      bend_ = curvature.slope_of_over_sn(s_, slope_);
    });
    chord_ = 2 * (motion.first.transpose() * q.cross(y_));
  }

  // Of d^2, q x q: f'' s_a s_b + f' s_ab, with s_ab = 2 <Z_a q, Z_b q> + 2 <y, acceleration_ab>.
  void add_second(double w, Eigen::MatrixXd& sum) const {
    const Eigen::Index count = motion_.parameters();
    const Vector3 metric = motion_.space.metric();
    const Eigen::VectorXd second = motion_.second.transpose() * q_.cross(y_);
    Eigen::Matrix3Xd moments(3, count);
    for (Eigen::Index a = 0; a < count; ++a) moments.col(a) = Vector3(velocity_.col(a)).cross(y_);
    const Eigen::MatrixXd turned = motion_.first.transpose() * moments;
    sum.noalias() += w * bend_ * chord_ * chord_.transpose();
    sum.noalias() += 2 * w * slope_ * (velocity_.transpose() * metric.asDiagonal() * velocity_);
    sum += w * slope_ *
           (turned + turned.transpose() + 2 * Eigen::Map<const Eigen::MatrixXd>(second.data(), count, count));
  }

  // Of the gradients -2 f' y at p, and 2 f' g^-1 y at the vertex whose image q is, tangential parts not yet
  // taken: 3 x q.
  Eigen::Matrix3Xd near_gradient() const {
    return -2 * (bend_ * y_ * chord_.transpose() + slope_ * velocity_);
  }
  Eigen::Matrix3Xd far_gradient(const Isometry& g) const {
    return 2 * g.inverse_matrix() * (bend_ * y_ * chord_.transpose() + slope_ * motion_.velocities(p_));
  }

 private:
  const VaryingMotion& motion_;
  Vector3 p_, q_, y_;
  Eigen::Matrix3Xd velocity_;
  Eigen::VectorXd chord_;
  double s_ = 0, slope_ = 1, bend_ = 0;
};

}  // namespace

ModuliEnergy::Curvature ModuliEnergy::curvature(const Points& x, const VaryingMarks& marks) const {
  const Points all = with_cones(x, positions_of(marks));
  const Eigen::Index count = marks.points().front().motion.parameters();
  const Space space = moduli_.space();
  const std::vector<VaryingIsometry> transform = varying_transforms(marks, count, Order::second);
  Curvature result = {Eigen::MatrixXd::Zero(count, count),
                      std::vector<Points>(count, Points::Zero(x.rows(), 3))};
  const auto add = [&](int v, const Eigen::Matrix3Xd& change) {
    if (cone_at_[v] >= 0) return;
    for (Eigen::Index a = 0; a < count; ++a)
      result.gradient[a].row(v) += space.tangent(all.row(v), change.col(a));
  };
  for (const int e : dependent_) {
    const GluedEdge& edge = edges_.edges[e];
    const bool is_at_cone = cone_at_[edge.i] >= 0 || cone_at_[edge.j] >= 0;
    const VaryingIsometry& g = transform[edge.t];
    const VaryingMotion at_cone = is_at_cone ? motion_along(edge, g, marks) : VaryingMotion();
    const MovingEdge moving(is_at_cone ? at_cone : g.motion, all.row(edge.i),
                            g.value * Vector3(all.row(edge.j)));
    moving.add_second(w_[e], result.energy);
    add(edge.i, w_[e] * moving.near_gradient());
    add(edge.j, w_[e] * moving.far_gradient(g.value));
  }
  for (Points& gradient : result.gradient) lower_rows(space, gradient);
  return result;
}

}  // namespace orbitutte
