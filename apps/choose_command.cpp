// SPDX-License-Identifier: MIT
// The table of the best cones of every family.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "command_arguments.h"
#include "commands.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/report/choices.h"
#include "page_pictures.h"

namespace orbitutte::cli {
namespace {

// Of a number that may not be known.
template <typename Known, typename Number>
std::string cell(const Known& known, const Number& number) {
  return known ? number(*known) : "-";
}

std::string exact_percent(double share) { return fmt::format("{:.2f} %", 100 * share); }

std::string verdict(const Choice& choice) {
  if (!choice.refusal.empty()) return choice.refusal;
  if (!choice.solved) return "not embedded";
  return choice.is_certified ? "certified" : "not certified";
}

void print_row(const Choice& choice) {
  const auto sigma = [](const auto& of) { return fmt::format("{:.4f}", of.sigma); };
  const auto within = [](const auto& of) { return exact_percent(of.within_4); };
  const auto below = [](const auto& of) { return exact_percent(of.below_64); };
  const auto& predicted = choice.predicted;
  const auto& solved = choice.solved;
  fmt::print("{:<9} {:<24} {:>8} {:>9} {:>9}  {:>8} {:>9} {:>9}  {}\n", choice.target.signature,
             fmt::format("{}", fmt::join(choice.cones, ",")), cell(predicted, sigma), cell(predicted, within),
             cell(predicted, below), cell(solved, sigma), cell(solved, within), cell(solved, below),
             verdict(choice));
}

std::vector<int> candidates_of(const Surface& surface, const Target& target) {
  if (surface.topology == Topology::projective_plane) return choose_cones(surface, target);
  const Candidates candidates = cone_candidates(surface);
  std::vector<int> all = candidates.inside;
  all.insert(all.end(), candidates.on_boundary.begin(), candidates.on_boundary.end());
  return all;
}

// The best choice that is certified, embedded once more.
void draw_best(const ChooseArguments& arguments, const Surface& surface, const std::vector<Choice>& choices,
               const EmbedOptions& options) {
  const auto best =
      std::find_if(choices.begin(), choices.end(), [](const Choice& choice) { return choice.is_certified; });
  if (best == choices.end())
    throw ArgumentError(
        "--picture: none of the choices that were embedded is certified; embed more (--solved)");
  const EmbedResult result = embed(surface, best->target, best->cones, options);
  write_scale_picture(arguments.picture, surface, result.embedding, candidates_of(surface, best->target));
}

}  // namespace

int choose_command(const ChooseArguments& arguments) {
  if (arguments.solved < 0) throw ArgumentError("--solved must not be negative");
  Wish wish = parse_wish(arguments.orbifold, arguments.cones);
  ChooseOptions options;
  options.objective = parse_choice<Objective>(arguments.objective, "--objective");
  options.embed.weights.kind = parse_choice<WeightKind>(arguments.weights, "--weights");
  options.embed.threads = arguments.threads;
  const auto surface =
      std::make_shared<const Surface>(make_surface(read_mesh(mesh_input(arguments.mesh, arguments.format))));
  mark_extremities(*surface, wish);
  options.target = wish.target;
  options.cones = wish.cones;
  const std::vector<Choice> choices = choose(surface, options, arguments.solved);
  const std::string json = choices_json(choices, options.objective);
  if (!arguments.output.empty()) write_file(arguments.output, json);
  if (!arguments.picture.empty()) draw_best(arguments, *surface, choices, options.embed);
  if (arguments.json) {
    fmt::print("{}", json);
    return succeeded;
  }
  fmt::print("{}: {} faces, the least {} first\n", arguments.mesh, surface->faces().count(),
             name_of(options.objective));
  fmt::print("{:<9} {:<24} {:>28}  {:>28}\n", "", "", "predicted", "embedded");
  fmt::print("{:<9} {:<24} {:>8} {:>9} {:>9}  {:>8} {:>9} {:>9}\n", "symbol", "cones", "sigma", "within 4",
             "below 64", "sigma", "within 4", "below 64");
  for (const Choice& choice : choices) print_row(choice);
  return succeeded;
}

}  // namespace orbitutte::cli
