// SPDX-License-Identifier: MIT
// E. Artin, "Theory of braids", Annals of Mathematics 48 (1947): the generators of pure braids.
#include "orbitutte/map/isotopy_class.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace orbitutte {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Four cones in the plane.

using UpperHalf = std::complex<double>;

UpperHalf shape_of_four(const Eigen::VectorXcd& p) {
  const UpperHalf t = (p[2] - p[1]) / (p[1] - p[0]);
  return t.imag() < 0 ? std::conj(t) : t;
}

double distance(const UpperHalf& s, const UpperHalf& t) {
  return 2 * std::asinh(std::abs(s - t) / (2 * std::sqrt(s.imag() * t.imag())));
}

Braid twists(int place, bool is_forth, int count) {
  return Braid(static_cast<std::size_t>(2 * count), HalfTwist{place, is_forth});
}

Eigen::VectorXcd twisted(const Eigen::VectorXcd& p, const Braid& braid) {
  return braid_matrix(static_cast<int>(p.size()), braid) * p;
}

// Twists of one pair of places, as many as bring Re t (or Re -1/t, for the second pair) nearest to zero.
Braid shortening(const Eigen::VectorXcd& p, int place) {
  const auto height = [&](const Eigen::VectorXcd& q) {
    const UpperHalf t = shape_of_four(q);
    return place == 0 ? t.real() : (-1.0 / t).real();
  };
  const double here = height(p), after = height(twisted(p, twists(place, true, 1)));
  const int count =
      static_cast<int>(std::lround(-here / (after - here)));  // each adds after - here = 2 or -2
  return twists(place, count > 0, std::abs(count));
}

// A braid that brings the shape into the fundamental domain |Re t| <= 1, |Re 1/t| <= 1 of Gamma(2).
Braid reduction(Eigen::VectorXcd p) {
  constexpr int most_steps = 200;
  Braid result;
  for (int step = 0; step < most_steps; ++step) {
    Braid braid = shortening(p, 0);
    p = twisted(p, braid);
    const Braid second = shortening(p, 1);
    p = twisted(p, second);
    braid.insert(braid.end(), second.begin(), second.end());
    if (braid.empty()) break;
    result = product(result, braid);
  }
  return result;
}

// The shorter words in the generators: all neighbours of the fundamental domain are among them.
std::vector<Braid> short_braids_of_four() {
  constexpr int longest = 4;
  std::vector<Braid> all = {{}}, last = all;
  for (int length = 1; length <= longest; ++length) {
    std::vector<Braid> next;
    for (const Braid& word : last)
      for (const int place : {0, 1})
        for (const bool is_forth : {true, false}) {
          Braid longer = product(word, twists(place, is_forth, 1));
          if (longer.size() > word.size()) next.push_back(std::move(longer));
        }
    all.insert(all.end(), next.begin(), next.end());
    last = std::move(next);
  }
  return all;
}

// Curved tiles.

// The logarithms of the distances between all pairs of cones.
Eigen::VectorXd log_distances(Space space, const Points& cones) {
  constexpr double least = 1e-9;
  const Eigen::Index k = cones.rows();
  Eigen::VectorXd result(k * (k - 1) / 2);
  Eigen::Index pair = 0;
  for (Eigen::Index i = 0; i < k; ++i)
    for (Eigen::Index j = i + 1; j < k; ++j)
      result[pair++] = std::log(std::max(space.distance(cones.row(i), cones.row(j)), least));
  return result;
}

double root_mean_square(const Eigen::VectorXd& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

// The cones moved so that their mean lies at (0, 0, 1), where coordinates have most digits; nothing if
// rounding has spoilt them.
std::optional<Points> tidy(const Moduli& moduli, const Points& cones) {
  constexpr double largest_defect = 1e-5;
  if (!cones.allFinite()) return std::nullopt;
  const Space space = moduli.space();
  const Vector3 mean = space.retract(cones.colwise().mean().transpose());
  if (!mean.allFinite()) return std::nullopt;
  Points result = space.to_origin(mean).on_rows(cones);
  retract_points(space, result);
  if (!(moduli.closing(result).cwiseAbs().maxCoeff() < largest_defect)) return std::nullopt;
  return result;
}

// Full twists of any two places, and of runs of three to k - 2 neighbours, forth and back.
std::vector<Braid> moves_of(int k) {
  std::vector<Braid> result;
  for (int i = 0; i < k; ++i)
    for (int j = i + 1; j < k; ++j)
      for (const bool is_forth : {true, false}) {
        result.push_back(full_twist(i, j, is_forth));
        if (j - i == 1) continue;
        Braid other_side = full_twist(i, j, is_forth);
        for (HalfTwist& twist : other_side)
          if (twist.place != i) twist.is_forth = !twist.is_forth;
        result.push_back(std::move(other_side));
        if (j - i + 1 > k - 2) continue;
        Braid run;
        for (int turn = 0; turn <= j - i; ++turn)
          for (int place = i; place < j; ++place) run.push_back({place, is_forth});
        result.push_back(std::move(run));
      }
  return result;
}

class ClassSearch {
 public:
  ClassSearch(const Moduli& moduli, const Points& a, const Points& b)
      : moduli_(moduli), wanted_(log_distances(moduli.space(), a)), moves_(moves_of(moduli.mark_count())) {
    here_.cones = tidy(moduli, b).value_or(b);
    here_.distance = distance_of(here_.cones);
  }

  IsotopyClass run() {
    constexpr int most_steps = 60;
    constexpr double much_nearer = 0.6;
    const Place first = here_;
    for (int step = 0; step < most_steps && advance(); ++step) continue;
    const double found = here_.distance;
    if (found > much_nearer * first.distance) here_ = first;
    const double next = next_distance();
    return {here_.braid, here_.distance, found < here_.distance ? std::min(found, next) : next};
  }

 private:
  struct Place {
    Points cones;
    Braid braid;
    double distance = infinity;
  };

  double distance_of(const Points& cones) const {
    return root_mean_square(log_distances(moduli_.space(), cones) - wanted_);
  }

  // Infinitely far away if rounding has spoilt it.
  Place moved(const Place& from, const Braid& move) const {
    Place to;
    const std::optional<Points> cones = tidy(moduli_, braided(moduli_, from.cones, move));
    if (!cones) return to;
    to.cones = *cones;
    to.braid = move;
    to.distance = distance_of(*cones);
    return to;
  }

  std::vector<Place> all_moved(const Place& from) const {
    std::vector<Place> result;
    for (const Braid& move : moves_) result.push_back(moved(from, move));
    return result;
  }

  bool is_gain(double distance) const { return distance < 0.98 * here_.distance - 1e-3; }

  static bool is_nearer(const Place& first, const Place& second) { return first.distance < second.distance; }

  // Takes the move that gains most; false if there is none.
  bool advance() {
    constexpr double near = 0.1;
    std::vector<Place> places = all_moved(here_);
    Place best = *std::min_element(places.begin(), places.end(), is_nearer);
    if (!is_gain(best.distance) && here_.distance > near) best = best_of_two(places);
    if (!is_gain(best.distance)) return false;
    best.braid = product(here_.braid, best.braid);
    best.cones = moduli_.closed(best.cones).value_or(best.cones);
    here_ = std::move(best);
    return true;
  }

  // Two moves at once, the first among the best.
  Place best_of_two(std::vector<Place>& places) const {
    constexpr std::size_t tried = 10;
    std::sort(places.begin(), places.end(), is_nearer);
    Place best;
    for (std::size_t k = 0; k < std::min(tried, places.size()); ++k) {
      if (!(places[k].distance < infinity)) break;
      for (const Braid& move : moves_) {
        Place place = moved(places[k], move);
        if (!is_nearer(place, best)) continue;
        place.braid = product(places[k].braid, move);
        best = std::move(place);
      }
    }
    return best;
  }

  // Of the classes one move away. Some moves change nothing, up to an isometry.
  double next_distance() const {
    constexpr double different = 1e-6;
    const Eigen::VectorXd lengths = log_distances(moduli_.space(), here_.cones);
    double least = infinity;
    for (const Place& place : all_moved(here_)) {
      if (!(place.distance < least)) continue;
      if (root_mean_square(log_distances(moduli_.space(), place.cones) - lengths) > different)
        least = place.distance;
    }
    return least;
  }

  const Moduli& moduli_;
  Eigen::VectorXd wanted_;
  std::vector<Braid> moves_;
  Place here_;
};

}  // namespace

IsotopyClass isotopy_class_of_four(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b) {
  constexpr double different = 1e-9;
  const Braid of_a = reduction(a), of_b = reduction(b);
  const UpperHalf wanted = shape_of_four(twisted(a, of_a));
  const Eigen::VectorXcd from = twisted(b, of_b);
  IsotopyClass best = {{}, infinity, infinity};
  UpperHalf best_shape;
  for (const Braid& between : short_braids_of_four()) {
    const UpperHalf shape = shape_of_four(twisted(from, between));
    const double d = distance(wanted, shape);
    if (best.distance < infinity && distance(best_shape, shape) < different) continue;
    if (d < best.distance) {
      best.next_distance = best.distance;
      best.distance = d;
      best.braid = product(product(of_b, between), inverse(of_a));
      best_shape = shape;
    } else {
      best.next_distance = std::min(best.next_distance, d);
    }
  }
  return best;
}

IsotopyClass isotopy_class(const Moduli& moduli, const Points& a, const Points& b) {
  return ClassSearch(moduli, a, b).run();
}

}  // namespace orbitutte
