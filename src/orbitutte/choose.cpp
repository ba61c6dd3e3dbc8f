// SPDX-License-Identifier: MIT
#include "orbitutte/choose.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "orbitutte/cones/extremities.h"
#include "orbitutte/cones/marked_cones.h"
#include "orbitutte/cones/scale_kernel.h"
#include "orbitutte/cones/search.h"
#include "orbitutte/orbifold/families.h"
#include "orbitutte/orbifold/polygon.h"
#include "orbitutte/orbifold/signature.h"
#include "orbitutte/orbifold/target_words.h"
#include "orbitutte/parallel.h"
#include "orbitutte/preparation.h"

namespace orbitutte {
namespace {

constexpr int candidate_count = 60;

// How many samples the search begins with, goes on with and ends with.
struct SampleCounts {
  int few = 125, some = 1000, many = 4000;
};

// Extremes are seen by many samples only.
SampleCounts sample_counts(Objective objective) {
  return objective == Objective::sigma ? SampleCounts() : SampleCounts{400, 4000, 8000};
}

// What sigma by fewer samples may be larger by than that of the best so far, when a choice is tried with
// more.
struct Margins {
  double few = 0.08, some = 0.005;
};

// Of which families the vertices are moved to where they are best, ring by ring.
enum class Polished { all, likely_best };

// How much is tried: all that is known where a table is wanted, or one target; where only the best of several
// families is, what is likely to be it.
struct Effort {
  int starts = 12, minima = 4;
  Polished polished = Polished::all;
};

constexpr Effort quick_effort = {6, 2, Polished::likely_best};

// So many families are likely to have the best choice, and those whose scale is an estimate.
constexpr int likely_families = 2;

constexpr int highest_order = 12;

// A family with its free order.
class FamilyWithOrder {
 public:
  explicit FamilyWithOrder(const Family& family) : name_(family.name), order_(family.smallest_order) {
    for (const auto* orders : {&family.pattern.rotations, &family.pattern.corners})
      has_free_order_ |= std::count(orders->begin(), orders->end(), 0) > 0;
  }

  bool has_free_order() const { return has_free_order_; }

  Target with(int order) const {
    std::string text = name_;
    std::replace(text.begin(), text.end(), 'N', '9');  // which no family has otherwise
    ConwaySymbol symbol = parse_orbifold(text).symbol;
    for (auto* orders : {&symbol.rotations, &symbol.corners})
      std::replace(orders->begin(), orders->end(), 9, order);
    return parse_orbifold(symbol.text());
  }

  Target with_least() const { return with(order_); }

 private:
  std::string name_;
  int order_;
  bool has_free_order_ = false;
};

// Targets that may be chosen: each the first of its family, whose order may grow.
struct Contest {
  Target first;
  std::optional<FamilyWithOrder> family;
};

bool lies_outside(const Candidates& all, int v) {
  return std::binary_search(all.on_boundary.begin(), all.on_boundary.end(), v);
}

// That the faces use them all, and that none is given twice.
void require_places(const std::vector<int>& kept, const Candidates& all) {
  for (const int v : kept) {
    if (!lies_outside(all, v) && !std::binary_search(all.inside.begin(), all.inside.end(), v))
      throw MeshError(fmt::format("vertex {} cannot be marked: no face of the mesh uses it", v));
    if (std::count(kept.begin(), kept.end(), v) > 1)
      throw MeshError(fmt::format("vertex {} is marked twice", v));
  }
}

std::vector<int> kept_vertices(const ChooseOptions& options) {
  std::vector<int> kept;
  for (const int v : options.cones)
    if (v != best_vertex) kept.push_back(v);
  return kept;
}

// Does the target have as many marks as there are entries, each where its kind has to be?
bool takes_cones(const Target& target, const Surface& surface, const Candidates& all,
                 const std::vector<int>& cones) {
  if (cones.empty()) return true;
  if (cones.size() != target.marks.size()) return false;
  for (int k = 0; k < static_cast<int>(cones.size()); ++k)
    if (cones[k] != best_vertex && surface.topology == Topology::disk &&
        lies_outside(all, cones[k]) != (k >= target.inner_marks))
      return false;
  return true;
}

// The spherical families that the surface embeds into and that take the cones; or the given target alone.
std::vector<Contest> contests(const Surface& surface, const Candidates& all, const ChooseOptions& options) {
  if (options.target && options.target->marks.empty())
    throw ArgumentError(fmt::format("{} marks no vertex: there are no cones to choose; embed into it",
                                    options.target->signature));
  if (options.target) return {{*options.target, std::nullopt}};
  std::vector<Contest> result;
  for (const Family& family : family_table()) {
    if (family.topology != surface.topology) continue;
    const FamilyWithOrder with_order(family);
    const Target first = with_order.with_least();
    if (first.group_order == 0 || first.marks.empty() || !takes_cones(first, surface, all, options.cones))
      continue;
    result.push_back({first, with_order.has_free_order() ? std::optional(with_order) : std::nullopt});
  }
  if (!result.empty()) return result;
  if (surface.topology == Topology::other) require_topology(surface, parse_orbifold("432"));
  throw MeshError(fmt::format("no orbifold for a {} takes {} marked vertices that lie like that",
                              text_of(surface.topology), options.cones.size()));
}

// The entries that are given, and for the others the first candidates of the right kind; nothing if there are
// too few.
std::optional<std::vector<int>> first_cones(const Target& target, const std::vector<int>& given,
                                            const Candidates& candidates) {
  std::vector<int> cones = given;
  cones.resize(target.marks.size(), best_vertex);
  for (int k = 0; k < static_cast<int>(cones.size()); ++k) {
    if (cones[k] != best_vertex) continue;
    const std::vector<int>& places = candidates.of(target, k);
    const auto is_free = [&](int v) { return std::find(cones.begin(), cones.end(), v) == cones.end(); };
    const auto at = std::find_if(places.begin(), places.end(), is_free);
    if (at == places.end()) return std::nullopt;
    cones[k] = *at;
  }
  return cones;
}

// The given vertices first, and then the farthest from those before.
Candidates candidates_around(const Surface& surface, const Target& base, const std::vector<int>& cones) {
  Candidates first;
  (base.inner_marks > 0 ? first.inside : first.on_boundary) = cones;
  return spread_candidates(surface, first, candidate_count);
}

// What the search begins with: a map to 222 or *222, and its cones, which are extremities.
struct BaseMap {
  EmbedResult result;
  std::vector<int> cones;
};

struct Scored {
  MarkedTarget choice;
  Score score;
};

bool is_lower(const Scored& a, const Scored& b) { return a.score < b.score; }

// The best of a family that were found from different starts, the best first.
using Minima = std::vector<Scored>;

// Up to rounding: then the cones differ in their order alone.
bool are_the_same(double a, double b) { return std::abs(a - b) <= 1e-7 * std::abs(a); }

// Sorts, and drops what is found twice and all but the best.
void keep_the_best(Minima& minima, int most) {
  std::stable_sort(minima.begin(), minima.end(), is_lower);
  Minima kept;
  kept.reserve(most);
  for (Scored& next : minima) {
    const bool is_known = std::any_of(kept.begin(), kept.end(), [&](const Scored& other) {
      return other.choice.cones == next.choice.cones || are_the_same(other.score.value, next.score.value);
    });
    if (!is_known && std::ssize(kept) < most) kept.push_back(std::move(next));
  }
  minima = std::move(kept);
}

// Brings the flagged ones to the front, in the order that they have, and says where the others begin.
std::vector<Minima>::iterator first_those(const std::vector<char>& is_flagged, std::vector<Minima>& all) {
  std::size_t next = 0;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (is_flagged[k]) {
      std::rotate(all.begin() + static_cast<std::ptrdiff_t>(next), all.begin() + k, all.begin() + k + 1);
      ++next;
    }
  return all.begin() + static_cast<std::ptrdiff_t>(next);
}

// The search over one surface, from its map to 222 or *222.
class BestCones {
 public:
  BestCones(const Surface& surface, const BaseMap& base, const ChooseOptions& options, const Effort& effort)
      : surface_(surface),
        options_(options),
        effort_(effort),
        neighbors_(vertex_neighbors(surface.connectivity.edges, surface.vertex_count())),
        stars_(surface),
        chart_(base.result.embedding),
        faces_(measure_triangles(surface, base.result.embedding)),
        order_(order_in_space(surface)),
        candidates_(candidates_around(surface, base.result.embedding.target, base.cones)),
        few_(chart_, stars_, few_samples(base)),
        some_(few_, samples(base, sample_counts(options.objective).some)),
        many_(few_, samples(base, sample_counts(options.objective).many)),
        first_search_(few_, surface, neighbors_, Objective::sigma),
        smooth_end_(some_, surface, neighbors_, Objective::sigma),
        search_(is_smooth() ? some_ : few_, surface, neighbors_, options.objective),
        end_(is_smooth() ? many_ : some_, surface, neighbors_, options.objective),
        freedom_{kept_vertices(options), !options.target.has_value()} {
    if (!is_smooth()) return;
    search_.look_first_at(few_, Margins().few);
    end_.look_first_at(some_, Margins().some);
  }

  // Of a family; nothing if no cones are possible.
  Minima best_of(const Contest& contest) {
    Minima best = descended(contest.first);
    if (best.empty() || !contest.family) return best;
    for (int order = contest.first.marks.front().order() + 1, failures = 0;
         order <= highest_order && failures < 2; ++order) {
      Scored next = {{contest.family->with(order), best.front().choice.cones}, {}};
      next.score = search_.descend(next.choice, candidates_, freedom_);
      const bool is_better = is_lower(next, best.front());
      failures = is_better ? 0 : failures + 1;
      if (is_better) best = {std::move(next)};
    }
    return best;
  }

  // Moves the vertices of the choices to where they are best, ring by ring, and keeps the best.
  void polish(Minima& minima) {
    if (!is_smooth()) minima.erase(minima.begin() + 1, minima.end());
    for (Scored& scored : minima) {
      (is_smooth() ? search_ : smooth_end_).polish(scored.choice, freedom_);
      scored.score = end_.score(scored.choice);
    }
    keep_the_best(minima, 1);
  }

  // With the most samples.
  void polish_in_the_end(Scored& scored) { scored.score = end_.polish(scored.choice, freedom_); }

  // By which families are compared before polish().
  void score(Minima& minima) {
    if (is_smooth()) return;  // that is known
    for (Scored& scored : minima) scored.score = end_.score(scored.choice);
    std::stable_sort(minima.begin(), minima.end(), is_lower);
  }

  ScaleSummary summary(const MarkedTarget& choice) { return many_.summary(choice); }

  // Of scores of the choice: by how much of themselves they may be off, as far as that is known.
  double relative_error(const MarkedTarget& choice) { return is_smooth() ? few_.relative_error(choice) : 0; }

  // The score, were an estimate as far off as it may be.
  Score at_best(const Scored& scored) {
    return {scored.score.is_lost, (1 - relative_error(scored.choice)) * scored.score.value};
  }

 private:
  bool is_smooth() const { return options_.objective == Objective::sigma; }

  KnownMap known(const BaseMap& base) const { return {surface_, base.result.embedding, faces_, order_}; }

  // Beside every candidate there is one, for the range.
  std::vector<ScaleSample> samples(const BaseMap& base, int count) const {
    std::vector<int> ends = candidates_.inside;
    ends.insert(ends.end(), candidates_.on_boundary.begin(), candidates_.on_boundary.end());
    return scale_samples(known(base), count, ends);
  }

  std::vector<ScaleSample> few_samples(const BaseMap& base) const {
    const int count = sample_counts(options_.objective).few;
    return is_smooth() ? scale_samples(known(base), count, {}) : samples(base, count);
  }

  // Where the search for the best cones of a target begins: at the best for other targets with as many marks;
  // if there are none, at the first candidates, the next ones and so on.
  std::vector<std::vector<int>> starts(const Target& target) const {
    std::vector<std::vector<int>> result;
    const auto add = [&](int first) {
      if (const auto cones = first_cones(target, options_.cones, candidates_from(first)))
        result.push_back(*cones);
    };
    if (const auto known = found_.find({target.marks.size(), target.inner_marks}); known != found_.end()) {
      result = known->second;
      add(0);
    } else {
      for (int k = 0; k < effort_.starts; ++k) add(3 * k);
    }
    return result;
  }

  Minima descended(const Target& target) {
    Minima minima;
    for (const std::vector<int>& cones : starts(target)) {
      Scored scored = {{target, cones}, {}};
      if (!search_.is_possible(scored.choice)) continue;
      scored.score = first_search_.descend(scored.choice, candidates_, freedom_);
      minima.push_back(std::move(scored));
    }
    if (is_smooth()) keep_the_best(minima, effort_.minima);
    for (Scored& scored : minima) scored.score = search_.descend(scored.choice, candidates_, freedom_);
    keep_the_best(minima, effort_.minima);
    if (minima.empty()) return minima;
    std::vector<std::vector<int>>& found = found_[{target.marks.size(), target.inner_marks}];
    found.clear();
    for (const Scored& scored : minima) found.push_back(scored.choice.cones);
    return minima;
  }

  // The candidates from one of them on, followed by those before it.
  Candidates candidates_from(int first) const {
    Candidates result = candidates_;
    for (std::vector<int>* places : {&result.inside, &result.on_boundary})
      std::rotate(places->begin(), places->begin() + std::min<std::ptrdiff_t>(first, std::ssize(*places)),
                  places->end());
    return result;
  }

  const Surface& surface_;
  const ChooseOptions& options_;
  Effort effort_;
  Neighbors neighbors_;
  VertexStars stars_;
  OrbifoldChart chart_;
  std::vector<FaceDistortion> faces_;
  std::vector<int> order_;
  Candidates candidates_;
  ScaleField few_, some_, many_;

  /// By sigma, from which the search for other objectives begins: they have many local minima.
  ConeSearch first_search_, smooth_end_;

  ConeSearch search_, end_;
  Freedom freedom_;

  /// The cones of the best choices so far for targets with so many marks, so many of them inside.
  std::map<std::pair<std::size_t, int>, std::vector<std::vector<int>>> found_;
};

// The symbol with its orders in such an order that kept vertices stand where they were given.
MarkedTarget in_given_order(MarkedTarget choice, const std::vector<int>& given) {
  for (int k = 0; k < static_cast<int>(given.size()); ++k) {
    if (given[k] == best_vertex) continue;
    const int at = static_cast<int>(std::find(choice.cones.begin(), choice.cones.end(), given[k]) -
                                    choice.cones.begin());
    if (at == k) continue;
    ConwaySymbol symbol = choice.target.symbol;
    std::vector<int>& orders = k < choice.target.inner_marks ? symbol.rotations : symbol.corners;
    const int first = k < choice.target.inner_marks ? 0 : choice.target.inner_marks;
    std::swap(orders[k - first], orders[at - first]);
    std::swap(choice.cones[k], choice.cones[at]);
    choice.target = parse_orbifold(symbol.text());
  }
  return choice;
}

// Candidates for targets whose scale has no closed form: they are embedded, one after the other.
std::vector<Choice> choices_to_try(const Surface& surface, const std::vector<Contest>& all,
                                   const ChooseOptions& options) {
  constexpr int vertices_tried = 4;
  std::vector<Choice> result;
  for (const Contest& contest : all) {
    const Target& target = contest.first;
    const std::vector<int> extremities = choose_cones(surface, target);
    const auto add = [&](const Target& aim, const std::vector<int>& cones) {
      result.push_back({aim, cones, {}, {}, false, {}});
    };
    if (target.marks.size() > 1) {
      const auto outer = extremities.begin() + target.inner_marks;
      const Candidates places = {{extremities.begin(), outer}, {outer, extremities.end()}};
      if (const auto cones = first_cones(target, options.cones, places)) add(target, *cones);
      continue;
    }
    const Candidates spread = spread_candidates(surface, {extremities, {}}, vertices_tried);
    const std::vector<int> kept = kept_vertices(options);
    for (const int v : kept.empty() ? spread.inside : kept) {
      add(target, {v});
      for (int order = target.marks.front().order() + 1; contest.family && order <= 3; ++order)
        add(contest.family->with(order), {v});
    }
  }
  return result;
}

// What is chosen is the map that a quotient is made from.
EmbedOptions without_quotient(EmbedOptions options) {
  options.quotient = {};
  return options;
}

// The rows of the table, the best first, as far as the closed form knows.
class Choosing {
 public:
  Choosing(std::shared_ptr<const Surface> surface, const ChooseOptions& options, const Effort& effort)
      : surface_(std::move(surface)),
        options_(options),
        effort_(effort),
        solver_(surface_, without_quotient(options.embed)) {}

  std::vector<Choice> table() {
    const Candidates all = all_places(*surface_);
    require_places(kept_vertices(options_), all);
    const std::vector<Contest> targets = contests(*surface_, all, options_);
    for (const Contest& contest : targets) {
      require_topology(*surface_, contest.first);
      if (!takes_cones(contest.first, *surface_, all, options_.cones))
        throw MeshError(
            fmt::format("{} needs {} marked vertices, {} of them inside the surface; give as many "
                        "entries for --cones, each where it has to lie",
                        contest.first.signature, contest.first.marks.size(), contest.first.inner_marks));
    }
    if (!std::all_of(targets.begin(), targets.end(),
                     [](const Contest& contest) { return has_closed_form(contest.first); }))
      return choices_to_try(*surface_, targets, options_);
    return predicted(targets);
  }

  // Where maps slide along an axis, the closed form estimates where they come to rest: what the search began
  // with may be better, and is to be embedded, too.
  void add_extremities(std::vector<Choice>& rows) const {
    if (!options_.target || !are_opposite(options_.target->marks)) return;
    if (options_.objective != Objective::sigma || !rows.front().predicted) return;
    Candidates ends;
    (options_.target->inner_marks > 0 ? ends.inside : ends.on_boundary) =
        choose_cones(*surface_, *options_.target);
    const auto cones = first_cones(*options_.target, options_.cones, ends);
    if (cones && !std::is_permutation(cones->begin(), cones->end(), rows.front().cones.begin()))
      rows.push_back({*options_.target, *cones, {}, {}, false, {}});
  }

  // Embeds the row, and writes into it what is known then.
  EmbedResult solve(Choice& choice) {
    EmbedResult result = solver_.embed(choice.target, choice.cones);
    choice.solved = result.distortion;
    choice.is_certified = result.certificate.bijective;
    return result;
  }

  // By how much of itself what is predicted of the row may be off, as far as that is known.
  double relative_error(const Choice& row) const {
    const auto at = relative_errors_.find(row.target.signature);
    return at == relative_errors_.end() ? 0 : at->second;
  }

  // What the first map and the search took.
  const Timings& timings() const { return timings_; }

 private:
  std::vector<Choice> predicted(const std::vector<Contest>& targets) {
    Stages stage(options_.embed.progress, timings_);
    const BaseMap base = stage("base", [&] { return base_map(); });
    return stage("choose", [&] { return search(base, targets); });
  }

  BaseMap base_map() {
    const Target target = standard_target(surface_->topology);
    const std::vector<int> cones = choose_cones(*surface_, target);
    return {solver_.embed(target, cones), cones};
  }

  std::vector<Choice> search(const BaseMap& base, const std::vector<Contest>& targets) {
    BestCones search(*surface_, base, options_, effort_);
    std::vector<Minima> found;
    for (const Contest& contest : targets)
      if (Minima minima = search.best_of(contest); !minima.empty()) found.push_back(std::move(minima));
    if (found.empty()) throw MeshError("the mesh has too few vertices to choose from");
    polish(search, found);
    std::vector<Choice> rows;
    rows.reserve(found.size());
    for (const Minima& minima : found) {
      const MarkedTarget marked = in_given_order(minima.front().choice, options_.cones);
      relative_errors_[marked.target.signature] = search.relative_error(marked);
      rows.push_back({marked.target, marked.cones, search.summary(marked), {}, false, {}});
    }
    std::stable_sort(rows.begin(), rows.end(), [&](const Choice& a, const Choice& b) {
      return score_of(*a.predicted, options_.objective) < score_of(*b.predicted, options_.objective);
    });
    return rows;
  }

  // All, or the few that may become the best: polishing gains about as much everywhere.
  void polish(BestCones& search, std::vector<Minima>& found) const {
    const auto is_better = [](const Minima& a, const Minima& b) { return is_lower(a.front(), b.front()); };
    for (Minima& minima : found) search.score(minima);
    std::stable_sort(found.begin(), found.end(), is_better);
    const Score least = found.front().front().score;
    std::vector<char> is_likely;
    for (const Minima& minima : found) {
      const Score at_best = search.at_best(minima.front());
      const bool may_lead = std::ssize(is_likely) < likely_families || at_best < minima.front().score;
      is_likely.push_back(wants_all() || (may_lead && is_close(at_best, least)));
    }
    const auto end = first_those(is_likely, found);
    for (auto minima = found.begin(); minima != end; ++minima) search.polish(*minima);
    std::stable_sort(found.begin(), end, is_better);
    for (auto minima = found.begin(); minima != (wants_all() ? end : found.begin() + 1); ++minima)
      search.polish_in_the_end(minima->front());
  }

  bool wants_all() const { return effort_.polished == Polished::all; }

  // May polishing make up for the difference to the best?
  static bool is_close(const Score& score, const Score& best) {
    constexpr double close = 1.03;
    return !(Score{best.is_lost, close * best.value} < score);
  }

  std::shared_ptr<const Surface> surface_;
  const ChooseOptions& options_;
  Effort effort_;
  EmbeddingSolver solver_;
  Timings timings_;

  /// Of what is predicted of each symbol.
  std::map<std::string, double> relative_errors_;
};

// What the embedding is judged by.
double value_of(const Distortion& distortion, const std::optional<ScaleSummary>& predicted,
                Objective objective) {
  if (objective == Objective::sigma || !predicted) return distortion.sigma;
  return score_of(*predicted, objective).value;
}

// May the row be clearly better than the value, going by the closed form, which may be off by so much of
// itself?
bool may_be_better(const Choice& row, double error, double value, Objective objective) {
  return !row.predicted || (1 - error) * score_of(*row.predicted, objective).value <= 0.98 * value;
}

std::string name_of_choice(const Choice& choice) {
  return fmt::format("{} at {}", choice.target.signature, fmt::join(choice.cones, ","));
}

std::string warning_of_better(const Choice& better, const Choice& taken) {
  return fmt::format("{} would distort less, but its map is not certified; {} was taken",
                     name_of_choice(better), name_of_choice(taken));
}

void add_warnings(BestEmbedding& best) {
  if (!best.choice().is_certified) return;
  for (const Choice& choice : best.choices)
    if (&choice != &best.choice() && (choice.solved || !choice.refusal.empty()) && !choice.is_certified)
      best.result.warnings.push_back(warning_of_better(choice, best.choice()));
}

// Of rows that have the same symbol.
void keep_what_was_taken(BestEmbedding& best) {
  if (best.choices.size() != 2 || !best.choices.front().predicted) return;
  best.choices = {best.choice()};
  best.taken = 0;
}

// Of rows that had to be embedded to be compared, the best of each symbol, the best first.
void keep_the_best_of_each(std::vector<Choice>& rows, Objective objective) {
  const auto rank = [&](const Choice& row) {
    const double value =
        row.solved ? value_of(*row.solved, {}, objective) : std::numeric_limits<double>::infinity();
    return std::pair(!row.is_certified, value);
  };
  std::stable_sort(rows.begin(), rows.end(),
                   [&](const Choice& a, const Choice& b) { return rank(a) < rank(b); });
  std::set<std::string> seen;
  std::erase_if(rows, [&](const Choice& row) { return !seen.insert(row.target.signature).second; });
}

template <typename Compute>
auto with_threads_for(const ChooseOptions& options, const Compute& compute) {
  if (options.embed.threads < 0) throw ArgumentError("the number of threads must not be negative");
  return with_threads(options.embed.threads, compute);
}

// What can be said against the map of fitted cones, the worst last.
enum class FittedFault { none, not_conformal, other_weights, not_certified };

FittedFault fault_of(const EmbedResult& result, const ConeWishes& wishes) {
  constexpr double far_from_conformal = 1.1;
  if (!result.certificate.bijective) return FittedFault::not_certified;
  if (result.requested_weights) return FittedFault::other_weights;
  const double conformality = result.minimum.energy / (2 * target_area(result.embedding.target));
  return are_placed(wishes) && conformality > far_from_conformal ? FittedFault::not_conformal
                                                                 : FittedFault::none;
}

const char* text_of(FittedFault fault) {
  if (fault == FittedFault::not_certified) return "their map is not certified";
  if (fault == FittedFault::other_weights) return "their map is certified with other weights only";
  return "their map is far from conformal";
}

// What is tried in place of these, in this order.
std::vector<FitOptions> milder_fits(const FitOptions& options) {
  constexpr double milder_angle = 1.6, milder_excess = 0.01, whatever_sigma = 1;
  std::vector<FitOptions> result;
  FitOptions milder = options;
  milder.greatest_angle = std::min(options.greatest(), milder_angle);
  if (milder.greatest() < options.greatest()) result.push_back(milder);
  milder.greatest_excess = std::min(options.greatest_excess, milder_excess);
  milder.sigma_for_shares = milder.sigma_in_vain = whatever_sigma;
  result.push_back(milder);
  return result;
}

// And what where none of that is certified: angles below 2 pi, for which the minimum is the only one, and at
// last up to pi, which turn nothing over at the tips of limbs.
std::vector<FitOptions> mildest_fits(const FitOptions& options) {
  std::vector<FitOptions> result;
  for (const double angle : {1.4, 1.2, 0.99, 0.5})
    if (angle < options.greatest()) {
      FitOptions& milder = result.emplace_back(milder_fits(options).back());
      milder.greatest_angle = angle;
    }
  return result;
}

// The cones for milder angles; none if there are no such.
std::optional<FittedCones> milder_cones(const ScaleKernel& kernel, ConeWishes wishes, const FitOptions& fit) {
  wishes.fit = fit;
  try {
    return find_cones(kernel, wishes);
  } catch (const MeshError&) {
    return std::nullopt;
  }
}

// Up to rounding.
bool are_the_same(const FittedCones& some, const FittedCones& others) {
  constexpr double rounding = 1e-9;
  const std::vector<double>&a = some.fit.angles, &b = others.fit.angles;
  return some.vertices == others.vertices &&
         std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](double x, double y) { return std::abs(x - y) < rounding; });
}

EmbedResult embed_cones(const Surface& surface, const std::string& signature, const FittedCones& cones,
                        const EmbedOptions& options) {
  const MarkedCones marked = marked_cones(surface, signature, cones.vertices, cones.fit.angles);
  return embed(surface, marked.target, marked.vertices, options);
}

}  // namespace

Candidates cone_candidates(const Surface& surface) {
  const Target base = standard_target(surface.topology);
  return candidates_around(surface, base, choose_cones(surface, base));
}

BestEmbedding embed_best(const std::shared_ptr<const Surface>& surface, const ChooseOptions& options) {
  return with_threads_for(options, [&] {
    if (!options.embed.quotient.is_wanted)
      require_no_quotient_options(options.embed.quotient,
                                  options.target ? options.target->signature : "the best orbifold");
    Choosing choosing(surface, options, options.target ? Effort() : quick_effort);
    BestEmbedding best = {options.objective, choosing.table(), -1, {}};
    choosing.add_extremities(best.choices);
    std::string first_refusal;
    double least = 0;
    for (std::size_t k = 0; k < best.choices.size(); ++k) {
      Choice& choice = best.choices[k];
      const bool has_certified = best.taken >= 0 && best.choice().is_certified;
      if (has_certified && !may_be_better(choice, choosing.relative_error(choice), least, options.objective))
        continue;
      try {
        EmbedResult result = choosing.solve(choice);
        const double value = value_of(result.distortion, choice.predicted, options.objective);
        const bool is_better =
            has_certified ? choice.is_certified && value < least : choice.is_certified || best.taken < 0;
        if (!is_better) continue;
        least = value;
        best.taken = static_cast<int>(k);
        best.result = std::move(result);
      } catch (const MeshError& error) {
        choice.refusal = error.what();
        if (first_refusal.empty()) first_refusal = error.what();
      }
    }
    if (best.taken < 0) throw MeshError(first_refusal);
    if (options.embed.quotient.is_wanted) best.result = quotient_of(*surface, best.result, options.embed);
    best.result.timings.insert(best.result.timings.begin(), choosing.timings().begin(),
                               choosing.timings().end());
    add_warnings(best);
    if (options.target) keep_what_was_taken(best);
    return best;
  });
}

EmbedResult embed_fitted(const Surface& surface, const std::string& signature, const FittedChoice& choice,
                         const EmbedOptions& options) {
  const ConeWishes& wishes = choice.wishes;
  const FittedCones& first = choice.cones;
  EmbedResult best = embed_cones(surface, signature, first, options);
  const FittedFault fault = fault_of(best, wishes);
  if (fault == FittedFault::none || wishes.are_orders) return best;
  const ScaleKernel kernel(surface, edge_weights(surface, {}), available_backends().front());
  FittedFault least = fault;
  Timings timings = best.timings;
  double sigma = first.fit.sigma;
  std::vector<FittedCones> tried = {first};
  const auto was_tried = [&](const FittedCones& cones) {
    return std::any_of(tried.begin(), tried.end(),
                       [&](const FittedCones& others) { return are_the_same(cones, others); });
  };
  const auto try_all = [&](const std::vector<FitOptions>& fits) {
    for (const FitOptions& fit : fits) {
      if (least == FittedFault::none) return;
      const std::optional<FittedCones> cones = milder_cones(kernel, wishes, fit);
      if (!cones || was_tried(*cones)) continue;
      tried.push_back(*cones);
      EmbedResult next = embed_cones(surface, signature, *cones, options);
      timings.insert(timings.end(), next.timings.begin(), next.timings.end());
      const FittedFault its_fault = fault_of(next, wishes);
      if (!(its_fault < least)) continue;
      least = its_fault;
      sigma = cones->fit.sigma;
      best = std::move(next);
    }
  };
  try_all(milder_fits(wishes.fit));
  if (least == FittedFault::not_certified) try_all(mildest_fits(wishes.fit));
  best.timings = std::move(timings);
  if (least != fault)
    best.warnings.push_back(fmt::format(
        "the cones of the least expected sigma, {:.3f}, were not taken, since {}; others, of a sigma of "
        "{:.3f}, were taken",
        first.fit.sigma, text_of(fault), sigma));
  return best;
}

std::vector<Choice> choose(std::shared_ptr<const Surface> surface, const ChooseOptions& options, int solved) {
  return with_threads_for(options, [&] {
    Choosing choosing(std::move(surface), options, Effort());
    std::vector<Choice> rows = choosing.table();
    for (Choice& row : rows) {
      if (row.predicted && solved-- <= 0) break;
      try {
        choosing.solve(row);
      } catch (const MeshError& error) {
        row.refusal = error.what();
      }
    }
    if (!rows.front().predicted) keep_the_best_of_each(rows, options.objective);
    return rows;
  });
}

}  // namespace orbitutte
