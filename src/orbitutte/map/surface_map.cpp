// SPDX-License-Identifier: MIT
#include "orbitutte/map/surface_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "orbitutte/certified_map.h"
#include "orbitutte/cut/tour.h"
#include "orbitutte/embed.h"
#include "orbitutte/map/guessed_rotation.h"
#include "orbitutte/map/isotopy_class.h"
#include "orbitutte/map/landmarks.h"
#include "orbitutte/orbifold/free_tile.h"
#include "orbitutte/orbifold/signature.h"
#include "orbitutte/parallel.h"
#include "orbitutte/solve/shared_placement.h"

namespace orbitutte {
namespace {

// Tours that shut themselves off are rare.
constexpr int most_tours = 24;

// The most landmarks for which classes are compared. With more, tiles reach so far out that braids cannot be
// followed in doubles.
constexpr int most_compared = 12;

// One of the two surfaces on the way to its embedding. The parts refer to each other.
struct MappedSide {
  MappedSide(const Surface& the_surface, const Target& the_target, const EmbedOptions& the_options)
      : surface(the_surface), options(the_options), prepared(prepare(surface, options)), target(the_target) {}
  MappedSide(const MappedSide&) = delete;
  MappedSide& operator=(const MappedSide&) = delete;

  EmbedRequest request() const { return {prepared, target, vertices, options}; }

  const Surface& surface;
  EmbedOptions options;
  PreparedSurface prepared;
  Target target;

  /// In the order of the target's marks.
  std::vector<int> vertices;
  EmbeddingCache cache = EmbeddingCache(Kept::order);
  CutMesh cut;
  EmbedResult result;
};

using Sides = std::array<std::unique_ptr<MappedSide>, 2>;

CutMesh cut_side(const MappedSide& side, const CutOptions& options) {
  const int inner = side.target.inner_marks;
  return (side.target.has_free_tile ? cut_along_tour : cut_to_disk)(side.surface, side.vertices, inner,
                                                                    options);
}

EmbedOptions quiet(EmbedOptions options) {
  options.progress = {};
  return options;
}

// The landmarks inside in the order of a tour, then those on the boundary.
std::vector<Landmark> in_order(const std::vector<Landmark>& landmarks, const LandmarkPlaces& places,
                               const std::vector<int>& tour) {
  std::vector<Landmark> marks;
  marks.reserve(landmarks.size());
  for (const int k : tour) marks.push_back(landmarks[places.inside[k]]);
  for (const int k : places.on_boundary) marks.push_back(landmarks[k]);
  return marks;
}

// Where tours begin on A: at the first landmark on the boundary, if there is one.
int start_of_tours(const std::vector<Landmark>& landmarks, const LandmarkPlaces& places) {
  return places.on_boundary.empty() ? -1 : landmarks[places.on_boundary.front()].a;
}

// The tour that was asked for, as indices into the landmarks inside.
std::vector<int> asked_tour(const std::vector<int>& tour, const LandmarkPlaces& places) {
  std::vector<int> result;
  for (const int k : tour) {
    const auto at = std::find(places.inside.begin(), places.inside.end(), k);
    const int place = static_cast<int>(at - places.inside.begin());
    if (at == places.inside.end() || std::count(result.begin(), result.end(), place) > 0)
      throw ArgumentError(
          fmt::format("the tour goes to {}, which is no landmark inside the surfaces or is met twice", k));
    result.push_back(place);
  }
  if (result.size() != places.inside.size())
    throw ArgumentError(fmt::format("the tour meets {} landmarks, but {} lie inside the surfaces",
                                    result.size(), places.inside.size()));
  return result;
}

// What the kind of tile, which is fixed, flat or curved, means for a map through so many landmarks.
struct TileFreedom {
  TileFreedom(const Target& target, int landmarks)
      : has_shape(target.has_free_tile),
        is_curved(target.has_curved_free_tile()),
        has_several_classes(has_shape && target.topology == Topology::sphere),
        has_classes(has_several_classes && (!is_curved || landmarks <= most_compared)),
        has_closed_form(!is_curved && landmarks == 4) {}

  /// Curved tiles of free shape are found by Newton's method, which goes beyond what is asked for; rounding
  /// keeps it from finer tolerances.
  double finest_tolerance() const { return is_curved ? 1e-9 : 0; }

  /// Is the shape of the tile found together with the map?
  bool has_shape;

  /// Then it takes a search, which begins with the tiles that both surfaces have of their own.
  bool is_curved;

  /// Are there several classes of maps, and are they compared? Classes of four landmarks in closed form.
  bool has_several_classes, has_classes, has_closed_form;
};

class Mapping {
 public:
  Mapping(const std::array<const Surface*, 2>& surfaces, const std::vector<Landmark>& landmarks,
          const LandmarkPlaces& places, const Target& target, const MapOptions& options)
      : surfaces_(surfaces),
        options_(options),
        places_(places),
        target_(target),
        freedom_(target, places.count()),
        stage_(options.embed.progress, map_.timings) {
    map_.landmarks = landmarks;
    map_.map_class.tile = options.tile;
  }

  SurfaceMap run() {
    find_tours();
    embed_both({options_.embed.weights.kind, options_.embed.weights.kind});
    if (!is_bijective() && is_converged()) try_other_tours();
    if (!is_bijective() && is_converged()) try_other_weights();
    warn_of_classes();
    map_.a = std::move(sides_[0]->result);
    map_.b = std::move(sides_[1]->result);
    return std::move(map_);
  }

 private:
  using Weights = std::array<WeightKind, 2>;
  using Problems = std::array<std::optional<GluingProblem>, 2>;

  // The tour that was asked for comes first.
  void find_tours() {
    stage_("tour", [&] {
      std::vector<int> inside;
      for (const int k : places_.inside) inside.push_back(map_.landmarks[k].a);
      tours_ = short_tours(*surfaces_[0], inside, start_of_tours(map_.landmarks, places_), most_tours);
      if (!options_.tour.empty()) tours_.insert(tours_.begin(), asked_tour(options_.tour, places_));
    });
    stage_("prepare", [&] {
      for (int s = 0; s < 2; ++s)
        sides_[s] = std::make_unique<MappedSide>(*surfaces_[s], target_, quiet(options_.embed));
    });
    cut_along_next(0);
  }

  void cut_along(std::size_t tour) {
    const std::array<CutOptions, 2> cuts = {options_.cut_a, options_.cut_b};
    const std::vector<Landmark> marks = in_order(map_.landmarks, places_, tours_[tour]);
    stage_("cut", [&] {
      parallel_for(2, [&](int s) {
        MappedSide& side = *sides_[s];
        side.vertices.clear();
        for (const Landmark& mark : marks) side.vertices.push_back(s == 0 ? mark.a : mark.b);
        side.cut = cut_side(side, cuts[s]);
      });
    });
    tour_ = tour;
  }

  // Along the first tour, from `tour` on, that does not shut itself off on either surface.
  void cut_along_next(std::size_t tour) {
    for (; tour < tours_.size(); ++tour) {
      try {
        cut_along(tour);
        return;
      } catch (const MeshError&) {
        if (tour + 1 == tours_.size()) throw;
      }
    }
  }

  bool is_bijective() const {
    return sides_[0]->result.certificate.bijective && sides_[1]->result.certificate.bijective;
  }

  // Curved tiles that are cut along a long tour reach far out, where digits are lost, and flat ones are not
  // always found there: the shortest tours take the place of one that was asked for. The first results are
  // kept if none is certified.
  void try_other_tours() {
    constexpr std::size_t most_tries = 3;
    if (options_.tour.empty() || !freedom_.has_shape) return;
    const std::array<EmbedResult, 2> results = {sides_[0]->result, sides_[1]->result};
    const SharingOptions sharing = sharing_;
    const MapClass first_class = map_.map_class;
    const std::vector<std::string> warnings = map_.warnings;
    const std::size_t first = tour_, end = std::min(tours_.size(), first + 1 + most_tries);
    for (std::size_t tour = first + 1; tour < end && tour > tour_; tour = tour_ + 1) {
      sharing_ = {};
      map_.map_class.tile = options_.tile;
      map_.warnings.clear();
      cut_along_next(tour);
      embed_both({options_.embed.weights.kind, options_.embed.weights.kind});
      if (is_bijective()) return;
    }
    cut_along(first);
    sharing_ = sharing;
    map_.map_class = first_class;
    map_.warnings = warnings;
    for (int s = 0; s < 2; ++s) sides_[s]->result = results[s];
  }

  // Where no weights were asked for: others for the side that needs them.
  void try_other_weights() {
    const EmbedOptions& embed = options_.embed;
    if (embed.weights.kind != WeightKind::standard || !embed.weights_file.empty()) return;
    const std::array<EmbedResult, 2> first = {sides_[0]->result, sides_[1]->result};
    const MapClass first_class = map_.map_class;
    const std::vector<std::string> warnings = map_.warnings;
    for (std::size_t k = 0; k < 3; ++k) {
      map_.warnings = warnings;
      Weights kinds = {WeightKind::standard, WeightKind::standard};
      for (int s = 0; s < 2; ++s) {
        const std::vector<WeightKind> others = other_weights(*surfaces_[s]);
        if (!first[s].certificate.bijective) kinds[s] = others[std::min(k, others.size() - 1)];
      }
      embed_both(kinds);
      if (!is_bijective()) continue;
      for (int s = 0; s < 2; ++s)
        if (kinds[s] != WeightKind::standard) sides_[s]->result.requested_weights = first[s].weights.kind;
      return;
    }
    map_.map_class = first_class;
    map_.warnings = warnings;
    for (int s = 0; s < 2; ++s) sides_[s]->result = first[s];
  }

  void embed_both(const Weights& kinds) {
    stage_("weights", [&] {
      parallel_for(2, [&](int s) {
        MappedSide& side = *sides_[s];
        side.options.weights.kind = kinds[s];
        side.result = {};
        side.result.weights = find_weights(side.request(), side.cache);
      });
    });
    Problems problems;
    state_problems(problems);
    // Other weights change neither the class nor much of the tiles.
    if (sharing_.own[0].cones.size() == 0) {
      if (freedom_.has_classes)
        find_class(problems);
      else if (needs_own_tiles())
        sharing_.own = own_tiles(pair_of(problems), lbfgs(), stage_);
    }
    finish_both(pair_of(problems), placed(pair_of(problems)));
  }

  void state_problems(Problems& problems) {
    stage_("prepare", [&] {
      for (int s = 0; s < 2; ++s) {
        const MappedSide& side = *sides_[s];
        problems[s].emplace(gluing_problem(side.request(), side.result.weights, side.cut, side.cache));
      }
    });
  }

  static ProblemPair pair_of(const Problems& problems) { return {*problems[0], *problems[1]}; }

  // Compares the tiles that both surfaces have of their own. Where the cut of B is twisted against that of A,
  // other tours are tried: maps from twisted cuts lie further out in the hyperbolic plane, where digits are
  // lost.
  void find_class(Problems& problems) {
    constexpr std::size_t most_tries = 6;
    compare(problems);
    const std::size_t first = tour_, end = std::min(tours_.size(), first + most_tries);
    std::size_t best = first, fewest = sharing_.braid.size(), last = first;
    for (std::size_t tour = first + 1; is_twisted() && tour < end; ++tour) {
      last = tour;
      if (!compare_along(tour, problems) || sharing_.braid.size() >= fewest) continue;
      best = tour;
      fewest = sharing_.braid.size();
    }
    if (last != best) compare_along(best, problems);
  }

  // False if the tour shuts itself off.
  bool compare_along(std::size_t tour, Problems& problems) {
    try {
      cut_along(tour);
      state_problems(problems);
      compare(problems);
      return true;
    } catch (const MeshError&) {
      return false;
    }
  }

  bool is_twisted() const { return freedom_.is_curved && !sharing_.braid.empty(); }

  void compare(const Problems& problems) {
    sharing_.own = own_tiles(pair_of(problems), lbfgs(), stage_);
    const IsotopyClass found = stage_("class", [&] { return class_of(sharing_.own); });
    sharing_.braid = found.braid;
    map_.map_class.distance = found.distance;
    map_.map_class.next_distance = found.next_distance;
    map_.map_class.half_twists = static_cast<int>(found.braid.size());
  }

  IsotopyClass class_of(const std::array<TiledPositions, 2>& own) const {
    if (!freedom_.has_closed_form)
      return isotopy_class(moduli_of(target_, sides_[0]->cut), own[0].cones, own[1].cones);
    const auto complex = [](const Points& cones) {
      Eigen::VectorXcd result(cones.rows());
      for (Eigen::Index k = 0; k < cones.rows(); ++k) result[k] = {cones(k, 0), cones(k, 1)};
      return result;
    };
    return isotopy_class_of_four(complex(own[0].cones), complex(own[1].cones));
  }

  LbfgsOptions lbfgs() const {
    LbfgsOptions result;
    result.tolerance = std::max(options_.embed.tolerance, freedom_.finest_tolerance());
    result.max_iterations = options_.embed.max_iterations;
    return result;
  }

  std::array<Placement, 2> placed(const ProblemPair& problems) {
    if (!freedom_.has_shape) return placed_alone(problems);
    if (map_.map_class.tile == TileShape::shared) {
      if (std::optional<std::array<Placement, 2>> shared = placed_on_shared_tile(problems)) return *shared;
      map_.map_class.tile = TileShape::regular;
    }
    return placed_together(problems);
  }

  // Nothing, but a warning, if the shape of the tile is not found.
  std::optional<std::array<Placement, 2>> placed_on_shared_tile(const ProblemPair& problems) {
    std::string reason = "it did not converge";
    try {
      std::array<Placement, 2> placed = placed_together(problems);
      if (placed[0].minimum.termination == Termination::converged &&
          placed[1].minimum.termination == Termination::converged)
        return placed;
    } catch (const MeshError& error) {
      reason = error.what();
    }
    map_.warnings.push_back(fmt::format(
        "no shared tile was found: {}; a regular one was taken, which makes the map less even", reason));
    return std::nullopt;
  }

  bool is_converged() const {
    return sides_[0]->result.minimum.termination == Termination::converged &&
           sides_[1]->result.minimum.termination == Termination::converged;
  }

  // Onto the tile that the target has.
  std::array<Placement, 2> placed_alone(const ProblemPair& problems) {
    return {place(problems[0], lbfgs(), stage_), place(problems[1], lbfgs(), stage_)};
  }

  std::array<Placement, 2> placed_together(const ProblemPair& problems) {
    sharing_.is_tile_regular = map_.map_class.tile == TileShape::regular;
    if (sharing_.is_tile_regular && target_.topology != Topology::sphere)
      throw ArgumentError("the tile of a disk has no regular shape; take the shared one (--tile shared)");
    sharing_.lbfgs = lbfgs();
    return place_together(problems, sharing_, stage_);
  }

  // Where the search for the shape of a shared tile begins.
  bool needs_own_tiles() const { return freedom_.is_curved && map_.map_class.tile == TileShape::shared; }

  void finish_both(const ProblemPair& problems, const std::array<Placement, 2>& placed) {
    // The map stays in its frame, which both surfaces have: more digits come before turning it. Limbs have
    // them in any case, since what is off there shows in full size on the other surface.
    const std::vector<Remedy> remedies = {with_faces_repaired, with_tips_unrolled, with_more_digits,
                                          with_limbs_resolved};
    for (int s = 0; s < 2; ++s) {
      MappedSide& side = *sides_[s];
      EmbedResult& result = side.result;
      result.minimum = placed[s].minimum;
      result.threads = thread_count();
      result.backend = side.options.laplacian.backend;
      Stages stage(options_.embed.progress, result.timings);
      finish(side.request(), problems[s], {placed[s], remedies, with_limbs_in_place}, stage, result);
      map_.timings.insert(map_.timings.end(), result.timings.begin(), result.timings.end());
    }
  }

  void warn_of_classes() {
    constexpr double close = 2;
    MapClass& found = map_.map_class;
    if (!freedom_.has_several_classes) return;
    if (!freedom_.has_classes) {
      found.next_distance = std::numeric_limits<double>::infinity();
      return;
    }
    if (found.next_distance > close * found.distance) return;
    map_.warnings.push_back(fmt::format(
        "two classes of maps through these landmarks are about as good: the tiles of both surfaces differ by "
        "{:.3g} in the one that was taken and by {:.3g} in the next; another landmark would decide",
        found.distance, found.next_distance));
  }

  std::array<const Surface*, 2> surfaces_;
  const MapOptions& options_;
  LandmarkPlaces places_;
  Target target_;
  TileFreedom freedom_;
  SurfaceMap map_;
  Stages stage_;
  Sides sides_;
  std::vector<std::vector<int>> tours_;
  std::size_t tour_ = 0;
  SharingOptions sharing_;
};

// Without landmarks: both onto the whole sphere, B turned so that the scales of both agree best.
SurfaceMap guessed_map(const Surface& a, const Surface& b, const MapOptions& options) {
  landmark_places(a, b, {});
  if (a.topology != Topology::sphere)
    throw MeshError(
        "a map between two disks needs landmarks: three on the boundary, or one there and one inside");
  SurfaceMap map;
  Stages stage(options.embed.progress, map.timings);
  EmbedOptions embed_options = options.embed;
  embed_options.quotient = {};
  const Target sphere = parse_orbifold("1");
  stage("embed", [&] {
    map.a = embed(a, sphere, {}, embed_options);
    map.b = embed(b, sphere, {}, embed_options);
  });
  Embedding& turned = map.b.embedding;
  const Isometry rotation = stage("rotation", [&] {
    return guessed_rotation({b, turned}, {a, map.a.embedding});
  });
  turned.placement = turned.placement * rotation.inverse();
  map.warnings.push_back(
      "no landmarks were given: the map is a guess by where both surfaces shrink and grow on the sphere; "
      "give "
      "three landmarks or more to say what corresponds");
  return map;
}

// Where tiles of order two reach so far out in the hyperbolic plane that doubles do not hold them, a flat
// target takes their place.
SurfaceMap map_by_landmarks(const Surface& a, const Surface& b, const std::vector<Landmark>& landmarks,
                            const MapOptions& options) {
  constexpr int never_too_many = 6;
  const LandmarkPlaces places = landmark_places(a, b, landmarks);
  const std::array<const Surface*, 2> surfaces = {&a, &b};
  SurfaceMap map = Mapping(surfaces, landmarks, places, landmark_target(a.topology, places), options).run();
  if (map.is_bijective() || a.topology != Topology::sphere || places.count() <= never_too_many ||
      options.tile != TileShape::shared)
    return map;
  SurfaceMap flat =
      Mapping(surfaces, landmarks, places, flat_landmark_target(a.topology, places), options).run();
  return flat.is_bijective() ? flat : map;
}

}  // namespace

SurfaceMap map_between(const Surface& a, const Surface& b, const std::vector<Landmark>& landmarks,
                       const MapOptions& options) {
  if (options.embed.threads < 0) throw ArgumentError("the number of threads must not be negative");
  return with_threads(options.embed.threads, [&] {
    return landmarks.empty() ? guessed_map(a, b, options) : map_by_landmarks(a, b, landmarks, options);
  });
}

}  // namespace orbitutte
