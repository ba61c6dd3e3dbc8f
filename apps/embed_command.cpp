// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "command_arguments.h"
#include "commands.h"
#include "orbitutte/choose.h"
#include "orbitutte/cones/cone_wishes.h"
#include "orbitutte/cones/extremities.h"
#include "orbitutte/cones/marked_cones.h"
#include "orbitutte/distortion_floor.h"
#include "orbitutte/io/corner_file.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/orbifold/polygon.h"
#include "orbitutte/orbifold/target_words.h"
#include "orbitutte/report/choices.h"
#include "orbitutte/report/embedding_file.h"
#include "orbitutte/report/report.h"
#include "run.h"
#include "standard_streams.h"

namespace orbitutte::cli {
namespace {

// That angles are given where they are needed, and nowhere else.
void require_fitting_angles(const EmbedArguments& arguments) {
  if (takes_angles(arguments.orbifold) == !arguments.angles.empty()) return;
  throw ArgumentError(
      arguments.angles.empty()
          ? fmt::format("--angles is missing; {} has none of its own: give one for each marked vertex, as in "
                        "pi,pi,1.5pi,0.5pi, or 'fitted' for those of least distortion",
                        arguments.orbifold)
          : fmt::format("--angles gives the angles of cones or *cones, but {} has its own",
                        arguments.orbifold.empty() ? "the best orbifold" : arguments.orbifold));
}

constexpr const char* fitted_word = "fitted";

// What stands beside --angles fitted, and means nothing without.
void require_fitted_alone(const EmbedArguments& arguments) {
  if (arguments.angles == fitted_word) return;
  const bool is_fitted_asked =
      arguments.count != 0 || arguments.sigma != 0 || arguments.area != 0 || arguments.orders;
  if (is_fitted_asked)
    throw ArgumentError("--count, --sigma, --area and --orders are for fitted angles; give --angles fitted");
}

// The vertices that --cones gives in the search for fitted angles.
std::vector<int> kept_vertices(const EmbedArguments& arguments, const Surface& surface) {
  const ConesWord word = cones_word(arguments.cones);
  if (word == ConesWord::extremities) {
    const bool is_disk = topology_of_cones(arguments.orbifold) == Topology::disk;
    return choose_extremities(surface, {is_disk ? 0 : arguments.count, is_disk ? arguments.count : 0});
  }
  return word == ConesWord::none ? parse_cones(arguments.cones) : std::vector<int>();
}

ConeWishes cone_wishes(const EmbedArguments& arguments, const Surface& surface) {
  if (arguments.count < 0 || arguments.sigma < 0)
    throw ArgumentError("--count and --sigma must not be negative");
  ConeWishes wishes;
  wishes.kept = kept_vertices(arguments, surface);
  wishes.count = std::max(arguments.count, static_cast<int>(wishes.kept.size()));
  std::erase(wishes.kept, best_vertex);
  if (arguments.sigma > 0) wishes.sigma = arguments.sigma;
  wishes.fit.area = arguments.area;
  wishes.are_orders = arguments.orders;
  if (wishes.count == 0 && !wishes.sigma)
    throw ArgumentError("--count is missing; give the number of cones, or --sigma for as few as reach it");
  return wishes;
}

// Cones whose angles, and places as far as they are not given, fit the surface best.
FittedChoice choose_fitted(const EmbedArguments& arguments, const Surface& surface) {
  const ConeWishes wishes = cone_wishes(arguments, surface);
  FittedChoice choice = {wishes, find_cones(surface, wishes)};
  if (!arguments.quiet)
    tell("orbitutte: {} cones of fitted angles; sigma {:.3f} is expected\n", choice.cones.vertices.size(),
         choice.cones.fit.sigma);
  return choice;
}

// Cones of given angles, on the surface. The program chooses none of them.
Wish wish_for_angles(const EmbedArguments& arguments, const Surface& surface) {
  const std::vector<double> angles = parse_angles(arguments.angles);
  const ConesWord word = cones_word(arguments.cones);
  const std::vector<int> vertices =
      word == ConesWord::none ? parse_cones(arguments.cones) : std::vector<int>();
  if (word == ConesWord::best || std::count(vertices.begin(), vertices.end(), best_vertex) > 0)
    throw ArgumentError(fmt::format(
        "--cones leaves vertices to the program, but {} has none to choose from; give all of them, or "
        "'extremities'",
        arguments.orbifold));
  const MarkedCones marked = word == ConesWord::extremities
                                 ? cones_at_extremities(surface, arguments.orbifold, angles)
                                 : marked_cones(surface, arguments.orbifold, vertices, angles);
  return {marked.target, ConesWord::none, marked.vertices};
}

Wish polygon_wish(const std::vector<PolygonCorner>& corners) {
  const Target target = polygon_target(corners);
  return {target, ConesWord::none, corner_vertices(target)};
}

// What is asked for: an orbifold and its cones, as far as they are given, or a polygon with its corners.
Wish wish_from(const EmbedArguments& arguments) {
  const bool polygon = arguments.orbifold == polygon_signature;
  if (!polygon && !arguments.polygon.empty())
    throw ArgumentError(
        fmt::format("--polygon gives the corners of a fixed boundary, but {} has no such boundary; give "
                    "--orbifold polygon",
                    arguments.orbifold.empty() ? "the best orbifold" : arguments.orbifold));
  if (!polygon) return parse_wish(arguments.orbifold, arguments.cones);
  if (arguments.polygon.empty())
    throw ArgumentError(
        "--polygon is missing; give the file with the corners of the polygon, a line 'vertex x y z' each");
  if (!arguments.cones.empty())
    throw ArgumentError("leave out --cones: the lines of the file of --polygon name the marked vertices");
  return polygon_wish(read_corners(arguments.polygon));
}

// The vertex that a marked one has become by the repair.
int followed(int vertex, const std::vector<int>& image) {
  if (vertex < 0 || vertex >= static_cast<int>(image.size()))
    return vertex;  // refused later, or not chosen yet
  const int became = image[vertex];
  if (became < 0)
    throw MeshError(fmt::format(
        "vertex {} is marked, but no face at it is left after the repair; mark another vertex", vertex));
  if (became != vertex)
    tell("orbitutte: warning: vertex {} was welded to vertex {}, which is marked in its place\n", vertex,
         became);
  return became;
}

std::vector<PolygonCorner> followed(std::vector<PolygonCorner> corners, const std::vector<int>& image) {
  for (PolygonCorner& corner : corners) corner.vertex = followed(corner.vertex, image);
  return corners;
}

// The same of --cones.
std::string followed(const std::string& cones, const std::vector<int>& image) {
  if (cones_word(cones) != ConesWord::none) return cones;
  const std::vector<int> vertices = parse_cones(cones);
  std::vector<std::string> entries;
  entries.reserve(vertices.size());
  for (const int vertex : vertices)
    entries.push_back(vertex == best_vertex ? "best" : std::to_string(followed(vertex, image)));
  return fmt::format("{}", fmt::join(entries, ","));
}

EmbedOptions options_from(const EmbedArguments& arguments) {
  EmbedOptions options;
  options.weights = {parse_choice<WeightKind>(arguments.weights, "--weights"), arguments.clamp};
  options.weights_file = arguments.weights_file;
  options.cut.seed = arguments.cut_seed;
  options.spread = parse_choice<Spread>(arguments.spread, "--spread");
  options.quotient.is_wanted = arguments.quotient;
  if (!arguments.centre.empty()) options.quotient.centre = parse_choice<Centre>(arguments.centre, "--centre");
  if (!arguments.points.empty()) options.quotient.points = read_corners(arguments.points);
  options.tolerance = arguments.tolerance;
  options.max_iterations = arguments.max_iterations;
  options.threads = arguments.threads;
  return options;
}

// "12.3 %"
std::string percent(double share) { return fmt::format("{:.1f} %", 100 * share); }

// By what the program chose; a single row without a prediction was compared with nothing.
std::string way_of_choice(const BestEmbedding& embedded) {
  const std::size_t count = embedded.choices.size();
  const bool is_predicted = embedded.choice().predicted.has_value();
  if (count == 1 && !is_predicted)
    return fmt::format("extremities, since nothing predicts better vertices for {}",
                       embedded.choice().target.signature);
  const std::string objective = fmt::format("for the least {}", name_of(embedded.objective));
  if (count == 1) return "chosen " + objective;
  return fmt::format("chosen of {} {} {}", count, is_predicted ? "families" : "maps", objective);
}

// What the program chose.
void summarize_choice(const BestEmbedding& embedded) {
  if (embedded.choices.empty()) return;
  const Choice& choice = embedded.choice();
  const std::string passed_over =
      embedded.taken > 0 && choice.predicted
          ? fmt::format("; {} with a better prediction turned out worse", embedded.taken)
          : std::string();
  tell("{}: --orbifold {} --cones {}{}\n", way_of_choice(embedded), choice.target.signature,
       fmt::join(choice.cones, ","), passed_over);
}

// "432 (group of order 24)"; the two symbols that hardly anybody knows, in words.
std::string text_of_target(const Target& target) {
  const std::string& symbol = target.signature;
  const std::string meaning = symbol == "1"   ? "the whole sphere"
                              : symbol == "*" ? "a hemisphere"
                                              : group_text(target);
  return fmt::format("{} ({})", symbol, meaning);
}

void summarize(const EmbedArguments& arguments, const BestEmbedding& embedded) {
  const EmbedResult& result = embedded.result;
  const Minimum& minimum = result.minimum;
  const Distortion& distortion = result.distortion;
  std::vector<int> cones;
  for (const ConeCopies& cone : result.embedding.cones) cones.push_back(cone.vertex);
  tell("{}: {} vertices, {} faces, a {}, onto {}{}\n", arguments.mesh, minimum.positions.rows(),
       result.embedding.faces().count(), text_of(result.topology), text_of_target(result.embedding.target),
       cones.empty() ? std::string() : fmt::format(", cones {}", fmt::join(cones, ",")));
  summarize_choice(embedded);
  if (const std::optional<QuotientRecord>& quotient = result.quotient)
    tell("the quotient of a map onto {}, cones {}; centre: {}\n", quotient->signature,
         fmt::join(quotient->cones, ","), name_of(quotient->centre));
  tell("energy {:.12g} after {} iterations, gradient {:.1e}: {}\n", minimum.energy, minimum.iterations,
       minimum.gradient_norm, name_of(minimum.termination));
  if (result.embedding.target.has_free_tile)
    tell(
        "the shape of the tile is the surface's own; energy over twice its area {:.6g}, where 1 is "
        "conformal\n",
        minimum.energy / (2 * target_area(result.embedding.target)));
  tell("area: within a factor of 4 of the mean scale on {} of the surface, shrunk by more than 64 on {}\n",
       percent(distortion.within_4), percent(distortion.below_64));
  tell("angles: median distortion {:.4g}, where 1 is none\n", distortion.angle.median);
  if (result.floor)
    tell("angles of the mesh subdivided twice, at best: median {:.4g}; mean {:.4g}, and {:.4g} of this map\n",
         result.floor->angle.median, result.floor->angle.mean, distortion.angle.mean);
  if (result.certificate.bijective) tell("certified: bijective\n");
}

// Measures the floor into the result, or warns that there is none.
void measure_floor(const Surface& surface, const EmbedOptions& options, EmbedResult& result) {
  std::vector<int> cones;
  for (const ConeCopies& cone : result.embedding.cones) cones.push_back(cone.vertex);
  result.floor = distortion_floor(surface, result.embedding.target, cones, options);
  if (!result.floor)
    result.warnings.push_back("the map of the mesh subdivided twice is not certified: there is no 'floor'");
}

// Advice to take weights that depend less on lengths and angles than these do; empty if there are none.
std::string other_weights(WeightKind kind) {
  if (kind == WeightKind::delaunay) return "take other weights (--weights cotan or uniform)";
  if (kind == WeightKind::uniform || kind == WeightKind::file) return "";
  return "take other weights (--weights uniform)";
}

// What may help if the result is not certified, in one sentence.
std::string remedy(const EmbedArguments& arguments, const EmbedResult& result) {
  if (!result.collapsing_faces.empty())
    return fmt::format(
        "What may help: mark a vertex of the faces that must become arcs, such as one of face {} (--cones); "
        "split an edge inside the mesh there.",
        result.collapsing_faces.front());
  std::vector<std::string> ways;
  const Termination termination = result.minimum.termination;
  if (termination == Termination::max_iterations) ways.push_back("allow more iterations (--max-iterations)");
  if (termination == Termination::line_search_failed)
    ways.push_back("ask for less accuracy (--tolerance 1e-8)");
  if (termination == Termination::converged && !result.embedding.target.is_polygon())
    ways.push_back("mark the tips of the longest limbs (--cones)");
  if (result.embedding.target.is_polygon())
    ways.push_back("take an orbifold such as *432, along whose mirrors the boundary may slide");
  const bool were_tried = arguments.weights == name_of(WeightKind::standard);
  if (const std::string way = other_weights(result.weights.kind); !way.empty() && !were_tried)
    ways.push_back(way);
  ways.push_back("make the mesh coarser or more even where the faces are smallest");
  return fmt::format("What may help: {}.", fmt::join(ways, "; "));
}

// What failed, one line for each check, and what may help.
void explain(const EmbedArguments& arguments, const EmbedResult& result) {
  const std::size_t turned = result.certificate.nonpositive_faces.size();
  if (turned > 0) {
    tell("orbitutte: not certified: {} of {} faces are not positive {}, the first face {}\n", turned,
         result.embedding.faces().count(), place_in(result.embedding.space()),
         result.certificate.nonpositive_faces.front());
  } else {
    tell("orbitutte: not certified, although every face is positive {}\n",
         place_in(result.embedding.space()));
  }
  for (const Check& check : result.certificate.checks)
    if (!check.passed) tell("  {}: {}\n", check.name, check.detail);
  if (result.intrinsic_certificate && result.intrinsic_certificate->bijective)
    tell("  the intrinsic Delaunay triangulation, which has the weights, is certified: bijective\n");
  tell("{}\n", remedy(arguments, result));
}

// Embeds what is asked for. There are choices in the result only if something was left to the program.
BestEmbedding embed_wish(const std::shared_ptr<const Surface>& surface, const Wish& wish,
                         const ChooseOptions& options) {
  if (wish.is_choice()) return embed_best(surface, options);
  return {options.objective, {}, 0, embed(*surface, *wish.target, wish.cones, options.embed)};
}

}  // namespace

void require_sound(const EmbedArguments& arguments) {
  options_from(arguments);
  require_fitting_angles(arguments);
  require_fitted_alone(arguments);
  parse_choice<Objective>(arguments.objective, "--objective");
  if (!takes_angles(arguments.orbifold)) {
    wish_from(arguments);
  } else if (arguments.angles != fitted_word) {
    parse_angles(arguments.angles);
  }
}

int embed_command(const EmbedArguments& asked) {
  const Stopwatch total;
  EmbedArguments arguments = asked;
  EmbedOptions options = options_from(arguments);
  require_fitting_angles(arguments);
  require_fitted_alone(arguments);
  const bool has_angles = takes_angles(arguments.orbifold);
  Wish wish = has_angles ? Wish() : wish_from(arguments);
  const Objective objective = parse_choice<Objective>(arguments.objective, "--objective");

  RunRecord run;
  const MeshInput source = mesh_input(arguments.mesh, arguments.format);
  const auto [surface, reader_warnings, image] =
      arguments.repair ? read_and_repair(source, run) : read_input(source, run);
  if (image) {
    if (!arguments.quiet) tell_steps(run.repair->records);
    arguments.cones = followed(arguments.cones, *image);
    options.quotient.points = followed(options.quotient.points, *image);
    if (arguments.orbifold == polygon_signature)
      wish = polygon_wish(followed(read_corners(arguments.polygon), *image));
    else if (!has_angles)
      wish = wish_from(arguments);
  }

  std::optional<FittedChoice> fitted;
  if (arguments.angles == fitted_word)
    fitted = choose_fitted(arguments, *surface);
  else if (has_angles)
    wish = wish_for_angles(arguments, *surface);
  if (!fitted) mark_extremities(*surface, wish);
  const ProgressLine line(arguments.quiet);
  options.progress = [&](const Progress& progress) {
    line.show(progress);
    return true;
  };
  BestEmbedding embedded =
      fitted ? BestEmbedding{objective, {}, 0, embed_fitted(*surface, arguments.orbifold, *fitted, options)}
             : embed_wish(surface, wish, {objective, wish.target, wish.cones, options});
  EmbedResult& result = embedded.result;
  if (arguments.floor) measure_floor(*surface, options, result);
  result.warnings.insert(result.warnings.begin(), reader_warnings.begin(), reader_warnings.end());
  run.strain = strain_statistics(measure_strain(*surface, result.embedding).at_vertices);
  line.clear();
  for (const std::string& warning : result.warnings) tell("orbitutte: warning: {}\n", warning);

  const Stopwatch writing;
  if (!arguments.output.empty()) write_file(arguments.output, serialize_embedding(result.embedding));
  run.write_seconds = writing.seconds();
  run.total_seconds = total.seconds();
  run.peak_memory_bytes = peak_memory_bytes();
  const std::string report = report_json(embedded, run);
  if (!arguments.report.empty()) write_file(arguments.report, report);
  if (arguments.json) fmt::print("{}", report);
  if (!arguments.quiet) summarize(arguments, embedded);
  if (result.certificate.bijective) return succeeded;
  explain(arguments, result);
  return result.minimum.termination == Termination::converged ? not_certified : not_converged;
}

}  // namespace orbitutte::cli
