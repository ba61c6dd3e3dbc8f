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

// The most landmarks for which classes are compared.
constexpr int most_compared = 8;

// Landmarks in the order of the marks of their target.
struct MarkedPair {
  Target target;
  std::vector<Landmark> marks;

  std::vector<int> vertices(int side) const {
    std::vector<int> result;
    for (const Landmark& landmark : marks) result.push_back(side == 0 ? landmark.a : landmark.b);
    return result;
  }
};

// One of the two surfaces on the way to its embedding. The parts refer to each other.
struct Side {
  Side(const Surface& the_surface, const MarkedPair& pair, int number, const EmbedOptions& the_options)
      : surface(the_surface),
        options(the_options),
        prepared(prepare(surface, options)),
        target(pair.target),
        vertices(pair.vertices(number)) {}
  Side(const Side&) = delete;
  Side& operator=(const Side&) = delete;

  EmbedRequest request() const { return {prepared, target, vertices, options}; }

  const Surface& surface;
  EmbedOptions options;
  PreparedSurface prepared;
  Target target;
  std::vector<int> vertices;
  EmbeddingCache cache = EmbeddingCache(Kept::order);
  CutMesh cut;
  EmbedResult result;
};

using Sides = std::array<std::unique_ptr<Side>, 2>;

CutMesh cut_side(const Side& side, const CutOptions& options) {
  const int inner = side.target.inner_marks;
  return (side.target.has_free_tile ? cut_along_tour : cut_to_disk)(side.surface, side.vertices, inner,
                                                                    options);
}

EmbedOptions quiet(EmbedOptions options) {
  options.progress = {};
  return options;
}

// The landmarks inside in the order of a tour, then those on the boundary.
MarkedPair in_order(const Target& target, const std::vector<Landmark>& landmarks,
                    const LandmarkPlaces& places, const std::vector<int>& tour) {
  MarkedPair pair = {target, {}};
  for (const int k : tour) pair.marks.push_back(landmarks[places.inside[k]]);
  for (const int k : places.on_boundary) pair.marks.push_back(landmarks[k]);
  return pair;
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

class Mapping {
 public:
  Mapping(const Surface& a, const Surface& b, const std::vector<Landmark>& landmarks,
          const MapOptions& options)
      : surfaces_{&a, &b},
        options_(options),
        places_(landmark_places(a, b, landmarks)),
        target_(landmark_target(a.topology, places_)),
        stage_(options.embed.progress, map_.timings) {
    map_.landmarks = landmarks;
    map_.map_class.tile = options.tile;
  }

  SurfaceMap run() {
    cut();
    embed_both({options_.embed.weights.kind, options_.embed.weights.kind});
    if (!is_bijective()) try_other_weights();
    map_.a = std::move(sides_[0]->result);
    map_.b = std::move(sides_[1]->result);
    return std::move(map_);
  }

 private:
  using Weights = std::array<WeightKind, 2>;

  // Along the first tour that does not shut itself off on either surface.
  void cut() {
    std::vector<std::vector<int>> tours;
    stage_("tour", [&] {
      std::vector<int> inside;
      for (const int k : places_.inside) inside.push_back(map_.landmarks[k].a);
      tours = short_tours(*surfaces_[0], inside, start_of_tours(map_.landmarks, places_), most_tours);
      if (!options_.tour.empty()) tours.insert(tours.begin(), asked_tour(options_.tour, places_));
    });
    stage_("cut", [&] {
      for (std::size_t k = 0; k < tours.size(); ++k) {
        try {
          cut_along(tours[k]);
          return;
        } catch (const MeshError&) {
          if (k + 1 == tours.size()) throw;
        }
      }
    });
  }

  void cut_along(const std::vector<int>& tour) {
    const MarkedPair pair = in_order(target_, map_.landmarks, places_, tour);
    for (int s = 0; s < 2; ++s)
      sides_[s] = std::make_unique<Side>(*surfaces_[s], pair, s, quiet(options_.embed));
    const std::array<CutOptions, 2> cuts = {options_.cut_a, options_.cut_b};
    parallel_for(2, [&](int s) { sides_[s]->cut = cut_side(*sides_[s], cuts[s]); });
  }

  bool is_bijective() const {
    return sides_[0]->result.certificate.bijective && sides_[1]->result.certificate.bijective;
  }

  // Where no weights were asked for: others for the side that needs them.
  void try_other_weights() {
    const EmbedOptions& embed = options_.embed;
    if (embed.weights.kind != WeightKind::standard || !embed.weights_file.empty()) return;
    const std::array<EmbedResult, 2> first = {sides_[0]->result, sides_[1]->result};
    for (std::size_t k = 0; k < 3; ++k) {
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
    for (int s = 0; s < 2; ++s) sides_[s]->result = first[s];
  }

  void embed_both(const Weights& kinds) {
    stage_("weights", [&] {
      parallel_for(2, [&](int s) {
        Side& side = *sides_[s];
        side.options.weights.kind = kinds[s];
        side.result = {};
        side.result.weights = find_weights(side.request(), side.cache.weights);
      });
    });
    std::array<std::optional<GluingProblem>, 2> problems;
    for (int s = 0; s < 2; ++s) {
      const Side& side = *sides_[s];
      problems[s].emplace(gluing_problem(side.request(), side.result.weights, side.cut, side.cache));
    }
    finish_both({*problems[0], *problems[1]}, placed({*problems[0], *problems[1]}));
  }

  LbfgsOptions lbfgs() const {
    LbfgsOptions result;
    result.tolerance = options_.embed.tolerance;
    result.max_iterations = options_.embed.max_iterations;
    return result;
  }

  std::array<Placement, 2> placed(const ProblemPair& problems) {
    if (!target_.has_free_tile) return placed_alone(problems);
    // The shapes of more landmarks lie too far out in the hyperbolic plane for a search.
    if (options_.tile == TileShape::shared && (places_.count() <= most_compared || is_flat())) {
      try {
        std::array<Placement, 2> shared = placed_together(problems, TileShape::shared);
        if (is_converged(shared)) return shared;
        map_.warnings.push_back(
            "the shape of the shared tile did not converge: a regular tile was taken, which makes the map "
            "less even");
      } catch (const MeshError& error) {
        map_.warnings.push_back(fmt::format(
            "no shared tile was found ({}): a regular tile was taken, which makes the map less even",
            error.what()));
      }
    }
    return placed_together(problems, TileShape::regular);
  }

  static bool is_converged(const std::array<Placement, 2>& placed) {
    return placed[0].minimum.termination == Termination::converged &&
           placed[1].minimum.termination == Termination::converged;
  }

  // Onto the tile that the target has.
  std::array<Placement, 2> placed_alone(const ProblemPair& problems) {
    return {place(problems[0], lbfgs(), stage_), place(problems[1], lbfgs(), stage_)};
  }

  std::array<Placement, 2> placed_together(const ProblemPair& problems, TileShape shape) {
    if (shape == TileShape::regular && target_.topology != Topology::sphere)
      throw ArgumentError("the tile of a disk has no regular shape; take the shared one (--tile shared)");
    map_.map_class.tile = shape;
    SharingOptions options;
    options.is_tile_regular = shape == TileShape::regular;
    options.lbfgs = lbfgs();
    if (has_classes()) options.choose_class = [&](const OwnTiles& tiles) { return chosen_class(tiles); };
    return place_together(problems, options, stage_);
  }

  bool is_flat() const { return target_.space == Space::plane(); }

  bool has_classes() const {
    return target_.topology == Topology::sphere && places_.count() <= most_compared;
  }

  Braid chosen_class(const OwnTiles& tiles) {
    const IsotopyClass found = stage_("class", [&] { return class_of(tiles); });
    map_.map_class.distance = found.distance;
    map_.map_class.next_distance = found.next_distance;
    map_.map_class.half_twists = static_cast<int>(found.braid.size());
    return found.braid;
  }

  IsotopyClass class_of(const OwnTiles& tiles) const {
    if (target_.space != Space::plane())
      return isotopy_class(moduli_of(target_, sides_[0]->cut), tiles.cones[0], tiles.cones[1]);
    const auto complex = [](const Points& cones) {
      Eigen::VectorXcd result(cones.rows());
      for (Eigen::Index k = 0; k < cones.rows(); ++k) result[k] = {cones(k, 0), cones(k, 1)};
      return result;
    };
    return isotopy_class_of_four(complex(tiles.cones[0]), complex(tiles.cones[1]));
  }

  void finish_both(const ProblemPair& problems, const std::array<Placement, 2>& placed) {
    warn_of_classes();
    // The map stays in its frame, which both surfaces have: more digits come before turning it.
    const std::vector<Remedy> remedies = {with_faces_repaired, with_more_digits, with_limbs_resolved};
    for (int s = 0; s < 2; ++s) {
      Side& side = *sides_[s];
      EmbedResult& result = side.result;
      result.minimum = placed[s].minimum;
      result.threads = thread_count();
      result.backend = side.options.laplacian.backend;
      Stages stage(options_.embed.progress, result.timings);
      finish(side.request(), problems[s], {placed[s], remedies}, stage, result);
    }
  }

  void warn_of_classes() {
    constexpr double close = 2;
    MapClass& found = map_.map_class;
    if (!target_.has_free_tile || target_.topology != Topology::sphere) return;
    if (!has_classes()) {
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
  SurfaceMap map_;
  Stages stage_;
  Sides sides_;
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

}  // namespace

SurfaceMap map_between(const Surface& a, const Surface& b, const std::vector<Landmark>& landmarks,
                       const MapOptions& options) {
  if (options.embed.threads < 0) throw ArgumentError("the number of threads must not be negative");
  return with_threads(options.embed.threads, [&] {
    return landmarks.empty() ? guessed_map(a, b, options) : Mapping(a, b, landmarks, options).run();
  });
}

}  // namespace orbitutte
