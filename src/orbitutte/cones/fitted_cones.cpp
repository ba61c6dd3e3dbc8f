// SPDX-License-Identifier: MIT
// Orthogonal matching pursuit: Y. C. Pati, R. Rezaiifar, P. S. Krishnaprasad, Asilomar Conference (1993).
#include "orbitutte/cones/fitted_cones.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "orbitutte/cones/search.h"

namespace orbitutte {
namespace {

using std::numbers::pi;

constexpr int fewest_candidates = 60, candidates_for_each_cone = 6, most_cones = 30;

// A change has to make sigma smaller by this factor.
constexpr double clearly = 0.999;

bool is_among(const std::vector<int>& some, int v) {
  return std::find(some.begin(), some.end(), v) != some.end();
}

// The fit of some of the vertices of a larger one.
CurvatureFit part_of(const CurvatureFit& all, const std::vector<int>& chosen) {
  return {all.gram(chosen, chosen), all.pull(chosen), all.variance};
}

// The vertices that may become cones, and all products among them.
class ConePlaces {
 public:
  ConePlaces(const ScaleKernel& kernel, std::vector<int> vertices, const FitOptions& options)
      : vertices_(std::move(vertices)), bounds_(bounds_of(kernel, vertices_, options)) {
    const int count = static_cast<int>(vertices_.size());
    all_ = {Eigen::MatrixXd(count, count), kernel.even_potential()(vertices_), kernel.even_variance()};
    constexpr int at_once = 8;  // a potential is as large as the mesh
    for (int begin = 0; begin < count; begin += at_once) {
      const int end = std::min(count, begin + at_once);
      const std::vector<int> some(vertices_.begin() + begin, vertices_.begin() + end);
      all_.gram.middleCols(begin, end - begin) = kernel.potentials(some)(vertices_, Eigen::all);
    }
  }

  int count() const { return static_cast<int>(vertices_.size()); }
  int vertex(int place) const { return vertices_[place]; }

  CurvatureBounds bounds(const std::vector<int>& chosen) const {
    return {bounds_.least(chosen), bounds_.greatest(chosen), bounds_.sum};
  }

  // The least sigma of cones at these places; infinite if no angles within the bounds have the area.
  double sigma(const std::vector<int>& chosen) const {
    const CurvatureBounds within = bounds(chosen);
    if (!within.can_be_met()) return std::numeric_limits<double>::infinity();
    const CurvatureFit fit = part_of(all_, chosen);
    return fit.sigma(least_sigma(fit, within));
  }

 private:
  std::vector<int> vertices_;
  CurvatureBounds bounds_;
  CurvatureFit all_;
};

// ConePlaces that were chosen, the first `kept` of which stay.
struct ChosenPlaces {
  std::vector<int> chosen;
  int kept = 0;
  double sigma = std::numeric_limits<double>::infinity();

  bool has(int place) const { return is_among(chosen, place); }
};

// Takes the place that helps most; if none does yet, the next one in the order of the places.
void grow(const ConePlaces& places, ChosenPlaces& selection) {
  int best = -1;
  double least = std::numeric_limits<double>::infinity();
  for (int place = 0; place < places.count(); ++place) {
    if (selection.has(place)) continue;
    std::vector<int> more = selection.chosen;
    more.push_back(place);
    const double sigma = places.sigma(more);
    if (best < 0 || sigma < least) best = place, least = sigma;
  }
  if (best < 0) throw MeshError("the mesh has fewer vertices than cones are wanted");
  selection.chosen.push_back(best);
  selection.sigma = least;
}

// Puts single cones to other places as long as that helps.
void exchange_places(const ConePlaces& places, ChosenPlaces& selection) {
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    for (std::size_t k = selection.kept; k < selection.chosen.size(); ++k)
      for (int place = 0; place < places.count(); ++place) {
        if (selection.has(place)) continue;
        std::vector<int> other = selection.chosen;
        other[k] = place;
        const double sigma = places.sigma(other);
        if (!(sigma < clearly * selection.sigma)) continue;
        selection.chosen = std::move(other);
        selection.sigma = sigma;
        goes_on = true;
      }
  }
}

// That one more cone helped, and that there are not too many yet.
void require_progress(const ChosenPlaces& selection, double before, double wanted) {
  const bool helps = selection.sigma < clearly * before || !std::isfinite(selection.sigma);
  if (selection.sigma <= wanted || (helps && static_cast<int>(selection.chosen.size()) < most_cones)) return;
  throw MeshError(fmt::format("{} cones leave a sigma of {:.3f}; {:.3g} is out of reach",
                              selection.chosen.size(), selection.sigma, wanted));
}

// The places at which greedy choice and exchange end.
ChosenPlaces choose_places(const ConePlaces& places, const ConeWishes& wishes) {
  ChosenPlaces selection;
  selection.kept = static_cast<int>(wishes.kept.size());
  selection.chosen.resize(selection.kept);
  std::iota(selection.chosen.begin(), selection.chosen.end(), 0);
  if (selection.kept > 0) selection.sigma = places.sigma(selection.chosen);
  const auto wants_more = [&] {
    return static_cast<int>(selection.chosen.size()) < wishes.count ||
           (wishes.sigma && !(selection.sigma <= *wishes.sigma));
  };
  while (wants_more()) {
    const double before = selection.sigma;
    grow(places, selection);
    if (!wishes.sigma) continue;
    exchange_places(places, selection);
    require_progress(selection, before, *wishes.sigma);
  }
  exchange_places(places, selection);
  if (!std::isfinite(selection.sigma)) refuse_bounds(places.bounds(selection.chosen));
  return selection;
}

// Moves single cones over the mesh.
class ConePolish {
 public:
  ConePolish(const ScaleKernel& kernel, const ConeWishes& wishes, std::vector<int> cones)
      : kernel_(kernel),
        kept_(wishes.kept.size()),
        bounds_(bounds_of(kernel, cones, wishes.fit)),
        neighbors_(vertex_neighbors(kernel.surface().connectivity.edges, kernel.surface().vertex_count())),
        cones_(std::move(cones)),
        potentials_(kernel.potentials(cones_)),
        fit_{potentials_(cones_, Eigen::all), kernel.even_potential()(cones_), kernel.even_variance()},
        curvatures_(least_sigma(fit_, bounds_)) {}

  void run() {
    constexpr int most_sweeps = 8;
    bool goes_on = true;
    for (int sweep = 0; goes_on && sweep < most_sweeps; ++sweep) {
      goes_on = false;
      for (std::size_t k = kept_; k < cones_.size(); ++k) goes_on |= move(static_cast<int>(k));
    }
  }

  const std::vector<int>& cones() const { return cones_; }
  const Eigen::VectorXd& curvatures() const { return curvatures_; }
  double sigma() const { return fit_.sigma(curvatures_); }

 private:
  // The fit with one cone at another vertex, whose potential this is.
  CurvatureFit with_moved(int cone, int vertex, const Eigen::VectorXd& potential) const {
    CurvatureFit fit = fit_;
    fit.pull[cone] = kernel_.even_potential()[vertex];
    fit.gram.row(cone) = potential(cones_).transpose();
    fit.gram.col(cone) = potential(cones_);
    fit.gram(cone, cone) = potential[vertex];
    return fit;
  }

  // Was there a better vertex for the cone? For small moves by c_v - c_w, sigma^2 changes by -2 x (r_v - r_w)
  // with the cone's curvature x and the potential r of what is left of u: in each ring of neighbours the
  // vertex is tried where this is least.
  bool move(int cone) {
    const Eigen::VectorXd promise =
        curvatures_[cone] * (kernel_.even_potential() - potentials_ * curvatures_);
    const std::vector<int> tried = best_of_rings(cones_[cone], promise);
    const Eigen::MatrixXd potentials = kernel_.potentials(tried);
    double least = clearly * sigma();
    int best = -1;
    for (std::size_t t = 0; t < tried.size(); ++t) {
      const CurvatureFit fit = with_moved(cone, tried[t], potentials.col(static_cast<Eigen::Index>(t)));
      const double sigma = fit.sigma(least_sigma(fit, bounds_));
      if (sigma < least) least = sigma, best = static_cast<int>(t);
    }
    if (best < 0) return false;
    fit_ = with_moved(cone, tried[best], potentials.col(best));
    cones_[cone] = tried[best];
    potentials_.col(cone) = potentials.col(best);
    curvatures_ = least_sigma(fit_, bounds_);
    return true;
  }

  // At one, two, four ... 32 edges from a vertex, the vertex of its kind with the greatest promise.
  std::vector<int> best_of_rings(int vertex, const Eigen::VectorXd& promise) const {
    std::vector<int> result;
    for (const std::vector<int>& ring : doubling_rings(neighbors_, vertex)) {
      int best = -1;
      for (const int v : ring)
        if (kernel_.flat_angle(v) == kernel_.flat_angle(vertex) && !is_among(cones_, v) &&
            (best < 0 || promise[v] > promise[best]))
          best = v;
      if (best >= 0) result.push_back(best);
    }
    return result;
  }

  const ScaleKernel& kernel_;
  std::size_t kept_;
  CurvatureBounds bounds_;
  Neighbors neighbors_;
  std::vector<int> cones_;

  /// n x cones.
  Eigen::MatrixXd potentials_;
  CurvatureFit fit_;
  Eigen::VectorXd curvatures_;
};

// The kept vertices, and then others that are spread over the surface.
std::vector<int> possible_vertices(const ScaleKernel& kernel, const ConeWishes& wishes) {
  Candidates first;
  for (const int v : wishes.kept)
    (kernel.flat_angle(v) > 1.5 * pi ? first.inside : first.on_boundary).push_back(v);
  const int count = std::max(fewest_candidates, candidates_for_each_cone * wishes.count);
  const Candidates spread = spread_candidates(kernel.surface(), first, count);
  std::vector<int> result = wishes.kept;
  for (const std::vector<int>* some : {&spread.inside, &spread.on_boundary})
    for (const int v : *some)
      if (!is_among(wishes.kept, v)) result.push_back(v);
  return result;
}

// The kept ones first, then the others, the most curved first.
FittedCones in_order(const ScaleKernel& kernel, const ConePolish& polish, std::size_t kept) {
  const std::vector<int>& cones = polish.cones();
  const Eigen::VectorXd& curvature = polish.curvatures();
  std::vector<int> order(cones.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(kept), order.end(),
                   [&](int a, int b) { return curvature[a] > curvature[b]; });
  FittedCones result;
  for (const int k : order) {
    result.vertices.push_back(cones[k]);
    result.fit.angles.push_back(kernel.flat_angle(cones[k]) - curvature[k]);
  }
  result.fit.area = kernel.total_curvature() - curvature.sum();
  result.fit.sigma = polish.sigma();
  return result;
}

// The orders whose angles are nearest.
std::vector<int> nearest_orders(const ScaleKernel& kernel, const std::vector<int>& cones,
                                const FittedAngles& fit, int highest) {
  std::vector<int> orders;
  for (std::size_t k = 0; k < cones.size(); ++k) {
    const double ratio = kernel.flat_angle(cones[k]) / fit.angles[k];
    orders.push_back(std::clamp(static_cast<int>(std::lround(ratio)), 2, highest));
  }
  return orders;
}

}  // namespace

FittedCones place_cones(const ScaleKernel& kernel, const ConeWishes& wishes) {
  if (!wishes.kept.empty()) fit_angles(kernel, wishes.kept, {std::nullopt});  // are they vertices?
  const ConePlaces places(kernel, possible_vertices(kernel, wishes), wishes.fit);
  std::vector<int> cones;
  for (const int place : choose_places(places, wishes).chosen) cones.push_back(places.vertex(place));
  ConePolish polish(kernel, wishes, std::move(cones));
  polish.run();
  FittedCones found = in_order(kernel, polish, wishes.kept.size());
  FitOptions options = wishes.fit;
  if (wishes.sigma) {  // what is reached stays reached
    const double room = *wishes.sigma / found.fit.sigma - 1;
    options.sigma_for_shares = std::min(options.sigma_for_shares, room);
    options.sigma_in_vain = std::min(options.sigma_in_vain, room);
  }
  const FittedAngles spared = fit_angles(kernel, found.vertices, options);
  if (!wishes.sigma || spared.sigma <= *wishes.sigma) found.fit = spared;
  return found;
}

FittedAngles fit_orders(const ScaleKernel& kernel, const std::vector<int>& cones, int highest_order) {
  const FittedAngles start = fit_angles(kernel, cones, {std::nullopt});
  std::vector<int> orders = nearest_orders(kernel, cones, start, highest_order);
  const CurvatureFit fit = {kernel.potentials(cones)(cones, Eigen::all), kernel.even_potential()(cones),
                            kernel.even_variance()};
  Eigen::VectorXd curvatures(static_cast<Eigen::Index>(cones.size()));
  const auto curvature = [&](std::size_t k, int order) {
    return kernel.flat_angle(cones[k]) * (1 - 1.0 / order);
  };
  for (std::size_t k = 0; k < cones.size(); ++k)
    curvatures[static_cast<Eigen::Index>(k)] = curvature(k, orders[k]);
  double sigma = fit.sigma(curvatures);
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    for (std::size_t k = 0; k < cones.size(); ++k)
      for (int order = 2; order <= highest_order; ++order) {
        Eigen::VectorXd other = curvatures;
        other[static_cast<Eigen::Index>(k)] = curvature(k, order);
        if (const double now = fit.sigma(other); now < clearly * sigma) {
          curvatures = other;
          sigma = now;
          goes_on = true;
        }
      }
  }
  FittedAngles result = {{}, kernel.total_curvature() - curvatures.sum(), sigma};
  for (std::size_t k = 0; k < cones.size(); ++k)
    result.angles.push_back(kernel.flat_angle(cones[k]) - curvatures[static_cast<Eigen::Index>(k)]);
  return result;
}

}  // namespace orbitutte
