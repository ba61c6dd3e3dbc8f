// SPDX-License-Identifier: MIT
// Times whole embeddings, stage by stage, and the yardstick T0 in the same process. Prints one JSON row per
// repetition.
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "orbitutte/embed.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/memory.h"
#include "orbitutte/mesh/subdivision.h"
#include "orbitutte/samples/sample.h"
#include "yardstick.h"

namespace {

using namespace orbitutte;

struct Arguments {
  std::string mesh;
  std::string orbifold = "432";
  std::vector<int> cones;
  int subdivisions = 0;
  int repetitions = 3;
  int threads = 0;
  int block_size = LaplacianOptions().block_size;
  std::string again;
  bool alone = false;
  std::vector<std::string> weights = {"standard", "cotan"};
};

struct Input {
  Mesh mesh;
  std::vector<int> cones;
};

// "figure:100000", "mask:100000", or a file.
Input load(const Arguments& arguments) {
  const auto colon = arguments.mesh.find(':');
  const std::string kind = arguments.mesh.substr(0, colon);
  Input input = {{}, arguments.cones};
  if (colon != std::string::npos && (kind == "figure" || kind == "mask")) {
    const SampleShape shape = kind == "figure" ? SampleShape::figure : SampleShape::mask;
    input.mesh = sample_mesh({shape, std::stoi(arguments.mesh.substr(colon + 1))});
    if (input.cones.empty()) input.cones = sample_cones(shape, input.mesh);
    if (shape == SampleShape::mask && arguments.cones.empty()) input.cones.resize(3);
  } else {
    input.mesh = to_triangle_mesh(read_mesh(arguments.mesh));
  }
  for (int k = 0; k < arguments.subdivisions; ++k) input.mesh = subdivided(input.mesh);
  const Target orbifold = parse_orbifold(arguments.orbifold);
  input.cones.resize(std::min(input.cones.size(), orbifold.marks.size()));
  return input;
}

// Makes the operating system count the peak memory anew from here on (Linux 4.0 and later).
void reset_peak_memory() { std::ofstream("/proc/self/clear_refs") << 5; }

long long peak_memory_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmHWM:", 0) == 0) return 1024 * std::stoll(line.substr(6));
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return 1024LL * usage.ru_maxrss;
}

EmbedOptions options_of(const Arguments& arguments, const std::string& weights) {
  EmbedOptions options;
  options.weights.kind = parse_choice<WeightKind>(weights, "--weights");
  options.threads = arguments.threads;
  options.laplacian.block_size = arguments.block_size;
  return options;
}

nlohmann::json time_embedding(const Arguments& arguments, const Input& input, const std::string& weights) {
  reset_peak_memory();
  const auto start = std::chrono::steady_clock::now();
  const EmbedResult result =
      embed(input.mesh, parse_orbifold(arguments.orbifold), input.cones, options_of(arguments, weights));
  const std::chrono::duration<double> total = std::chrono::steady_clock::now() - start;
  nlohmann::json row = {{"weights", weights},
                        {"threads", result.threads},
                        {"certified", result.certificate.bijective},
                        {"iterations", result.minimum.iterations},
                        {"evaluations", result.minimum.evaluations},
                        {"energy", result.minimum.energy},
                        {"peak_memory_bytes", peak_memory_bytes()},
                        {"total", total.count()},
                        {"stages", nlohmann::json::object()}};
  for (const auto& [stage, seconds] : result.timings)
    row["stages"][stage] = row["stages"].value(stage, 0.0) + seconds;
  return row;
}

// An embedding with each kind of weights.
nlohmann::json run_alone(const Arguments& arguments, const Input& input) {
  nlohmann::json row = {{"mesh", arguments.mesh},
                        {"subdivisions", arguments.subdivisions},
                        {"vertices", input.mesh.V.rows()},
                        {"faces", input.mesh.F.rows()},
                        {"orbifold", arguments.orbifold}};
  for (const std::string& weights : arguments.weights)
    row["embeddings"].push_back(time_embedding(arguments, input, weights));
  return row;
}

// The same after the yardstick, in multiples of it.
nlohmann::json run_beside_yardstick(const Arguments& arguments, const Input& input) {
  const benchmarks::Yardstick yardstick = benchmarks::measure_yardstick(input.mesh);
  nlohmann::json row = run_alone(arguments, input);
  row["T0"] = yardstick.metis.total_seconds();
  row["T0_analyze"] = yardstick.metis.analyze_seconds;
  row["T0_factorize"] = yardstick.metis.factorize_seconds;
  row["T0_amd"] = yardstick.amd.total_seconds();
  for (nlohmann::json& embedding : row["embeddings"])
    embedding["ratio"] = embedding["total"].get<double>() / yardstick.metis.total_seconds();
  return row;
}

// Makes two more embeddings with the solver that made the first: one with other orders, one with other cones.
nlohmann::json run_again(const Arguments& arguments, const Input& input) {
  EmbeddingSolver solver(input.mesh, options_of(arguments, arguments.weights.front()));
  nlohmann::json row = {{"mesh", arguments.mesh}, {"faces", input.mesh.F.rows()}, {"kind", "again"}};
  const auto embed_and_time = [&](const char* name, const std::string& orbifold,
                                  const std::vector<int>& cones) {
    const auto start = std::chrono::steady_clock::now();
    const EmbedResult result = solver.embed(parse_orbifold(orbifold), cones);
    const std::chrono::duration<double> total = std::chrono::steady_clock::now() - start;
    row[name] = {{"orbifold", orbifold},
                 {"certified", result.certificate.bijective},
                 {"iterations", result.minimum.iterations},
                 {"total", total.count()}};
    for (const auto& [stage, seconds] : result.timings) row[name]["stages"][stage] = seconds;
  };
  std::vector<int> others = input.cones;
  others.back() = static_cast<int>(input.mesh.V.rows() / 2);
  embed_and_time("first", arguments.orbifold, input.cones);
  embed_and_time("other_orders", arguments.again, input.cones);
  embed_and_time("other_cones", arguments.orbifold, others);
  return row;
}

nlohmann::json run(const Arguments& arguments, const Input& input) {
  if (!arguments.again.empty()) return run_again(arguments, input);
  return arguments.alone ? run_alone(arguments, input) : run_beside_yardstick(arguments, input);
}

}  // namespace

int main(int argc, char** argv) {
  orbitutte::use_huge_pages();
  Arguments arguments;
  CLI::App app{"Times embeddings beside T0, one factorisation of the mesh's Laplacian by CHOLMOD"};
  app.add_option("mesh", arguments.mesh, "figure:FACES, mask:FACES, or a mesh file")->required();
  app.add_option("--orbifold", arguments.orbifold, "Conway's symbol")->capture_default_str();
  app.add_option("--cones", arguments.cones, "Marked vertices; those of the sample where left out")
      ->delimiter(',');
  app.add_option("--subdivide", arguments.subdivisions, "Midpoint subdivisions first")->capture_default_str();
  app.add_option("--repeat", arguments.repetitions, "Repetitions")->capture_default_str();
  app.add_option("--threads", arguments.threads, "0: as many as the machine has")->capture_default_str();
  app.add_option("--block-size", arguments.block_size, "LaplacianOptions::block_size")->capture_default_str();
  app.add_option("--weights", arguments.weights, "Kinds of weights, an embedding with each")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--again", arguments.again,
                 "Time one solver instead: the orbifold, then this one, then other cones");
  app.add_flag("--alone", arguments.alone, "Without T0, so that the first embedding finds a cold process");
  CLI11_PARSE(app, argc, argv);
  try {
    const Input input = load(arguments);
    for (int k = 0; k < arguments.repetitions; ++k) std::cout << run(arguments, input).dump() << std::endl;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
