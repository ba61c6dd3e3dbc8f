// SPDX-License-Identifier: MIT
// The computation: options, progress, and solvers.
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>

#include "arrays.h"
#include "held_embedding.h"
#include "orbitutte/choose.h"
#include "orbitutte/distortion_floor.h"
#include "orbitutte/report/choices.h"
#include "progress_hook.h"

namespace orbitutte::python {
namespace {

// A mesh, and the solver that keeps what its embeddings have in common.
class Solver {
 public:
  Solver(std::shared_ptr<const SourceMesh> mesh, EmbedOptions options)
      : mesh_(std::move(mesh)), solver_(mesh_->surface(), with_hook(std::move(options))) {}

  HeldEmbedding embed(const Target& target, const std::vector<int>& cones, py::object listener) {
    const Busy busy(busy_);
    ProgressHook hook(std::move(listener));
    hook_ = &hook;
    try {
      const py::gil_scoped_release release;
      const Clock::time_point start = Clock::now();
      EmbedResult result = solver_.embed(target, cones);
      return hold(std::move(result), mesh_, seconds_since(start));
    } catch (const Cancelled&) {
      hook.rethrow();
      throw;
    }
  }

  const std::shared_ptr<const SourceMesh>& mesh() const { return mesh_; }

 private:
  // One computation at a time.
  class Busy {
   public:
    explicit Busy(std::atomic<bool>& flag) : flag_(flag) {
      if (flag_.exchange(true))
        throw ArgumentError("this solver is computing already; take one Solver for every thread");
    }
    ~Busy() { flag_ = false; }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;

   private:
    std::atomic<bool>& flag_;
  };

  EmbedOptions with_hook(EmbedOptions options) {
    options.progress = [this](const Progress& progress) { return (*hook_)(progress); };
    return options;
  }

  std::shared_ptr<const SourceMesh> mesh_;
  EmbeddingSolver solver_;
  ProgressHook* hook_ = nullptr;  // of the computation that runs
  std::atomic<bool> busy_ = false;
};

// For one embedding: without what a solver keeps for the next.
HeldEmbedding embed_once(const std::shared_ptr<SourceMesh>& mesh, const Target& target,
                         const std::vector<int>& cones, const EmbedOptions& options, py::object listener) {
  return with_listener(options, std::move(listener), [&](const EmbedOptions& heard) {
    const Clock::time_point start = Clock::now();
    EmbedResult result = embed(*mesh->surface(), target, cones, heard);
    return hold(std::move(result), mesh, seconds_since(start));
  });
}

// What is left to the program, and by what it chooses.
ChooseOptions choose_options(const std::optional<Target>& target, const std::vector<int>& cones,
                             const std::string& objective, const EmbedOptions& options) {
  return {parse_choice<Objective>(objective, "objective"), target, cones, options};
}

HeldEmbedding embed_chosen(const std::shared_ptr<SourceMesh>& mesh, const ChooseOptions& options,
                           py::object listener) {
  return with_listener(options.embed, std::move(listener), [&](const EmbedOptions& heard) {
    const Clock::time_point start = Clock::now();
    BestEmbedding best =
        embed_best(mesh->surface(), {options.objective, options.target, options.cones, heard});
    return hold(std::move(best), mesh, seconds_since(start));
  });
}

HeldEmbedding embed_with_fitted_cones(const std::shared_ptr<SourceMesh>& mesh, const std::string& signature,
                                      const ConeWishes& wishes, const EmbedOptions& options,
                                      py::object listener) {
  return with_listener(options, std::move(listener), [&](const EmbedOptions& heard) {
    const Clock::time_point start = Clock::now();
    const std::shared_ptr<const Surface> surface = mesh->surface();
    EmbedResult result = embed_fitted(*surface, signature, {wishes, find_cones(*surface, wishes)}, heard);
    return hold(std::move(result), mesh, seconds_since(start));
  });
}

// The table as JSON.
std::string table(const std::shared_ptr<SourceMesh>& mesh, const ChooseOptions& options, int solved,
                  py::object listener) {
  return with_listener(options.embed, std::move(listener), [&](const EmbedOptions& heard) {
    const std::vector<Choice> choices =
        choose(mesh->surface(), {options.objective, options.target, options.cones, heard}, solved);
    return choices_json(choices, options.objective);
  });
}

// None if there is no floor.
std::optional<py::dict> floor_of(const std::shared_ptr<SourceMesh>& mesh, const Target& target,
                                 const std::vector<int>& cones, const EmbedOptions& options,
                                 py::object listener) {
  const std::optional<Distortion> floor = with_listener(
      options, std::move(listener),
      [&](const EmbedOptions& heard) { return distortion_floor(*mesh->surface(), target, cones, heard); });
  return floor ? std::optional(to_dict(*floor)) : std::nullopt;
}

void set_weights(EmbedOptions& options, const std::string& text) {
  std::vector<std::string> choices = choices_of<WeightKind>();
  if (std::find(choices.begin(), choices.end(), text) != choices.end()) {
    options.weights.kind = *find_by_name<WeightKind>(text);
    return;
  }
  choices.insert(choices.end(), {"(i, j, w)", "a sparse matrix"});
  refuse_choice(text, "weights", choices);
}

void give_weights(EmbedOptions& options, const IntArray& i, const IntArray& j, const DoubleArray& w) {
  options.weights.kind = WeightKind::file;
  options.weights.given.clear();
  for (py::ssize_t k = 0; k < w.size(); ++k)
    options.weights.given.push_back({i.data()[k], j.data()[k], w.data()[k]});
}

void set_spread(EmbedOptions& options, const std::string& text) {
  options.spread = parse_choice<Spread>(text, "spread");
}

void set_centre(EmbedOptions& options, const std::string& text) {
  options.quotient.centre = parse_choice<Centre>(text, "centre");
}

void set_points(EmbedOptions& options, const std::vector<int>& vertices, const DoubleArray& positions) {
  const Points points = to_points(positions);
  options.quotient.points.clear();
  for (std::size_t k = 0; k < vertices.size(); ++k)
    options.quotient.points.push_back({vertices[k], points.row(static_cast<Eigen::Index>(k))});
}

}  // namespace

void bind_solver(py::module_& module) {
  py::class_<EmbedOptions>(module, "Options")
      .def(py::init<>())
      .def("set_weights", &set_weights)
      .def("give_weights", &give_weights)
      .def("set_spread", &set_spread)
      .def("set_centre", &set_centre)
      .def("set_points", &set_points)
      .def_property(
          "quotient", [](const EmbedOptions& options) { return options.quotient.is_wanted; },
          [](EmbedOptions& options, bool is_wanted) { options.quotient.is_wanted = is_wanted; })
      .def_readwrite("weights_file", &EmbedOptions::weights_file)
      .def_property(
          "clamp", [](const EmbedOptions& options) { return options.weights.clamp; },
          [](EmbedOptions& options, double clamp) { options.weights.clamp = clamp; })
      .def_property(
          "cut_seed", [](const EmbedOptions& options) { return options.cut.seed; },
          [](EmbedOptions& options, std::uint64_t seed) { options.cut.seed = seed; })
      .def_readwrite("tolerance", &EmbedOptions::tolerance)
      .def_readwrite("max_iterations", &EmbedOptions::max_iterations)
      .def_readwrite("threads", &EmbedOptions::threads);
  py::class_<Solver>(module, "Solver")
      .def(py::init([](std::shared_ptr<SourceMesh> mesh, const EmbedOptions& options) {
        const py::gil_scoped_release release;
        return std::make_unique<Solver>(std::move(mesh), options);
      }))
      .def("embed", &Solver::embed);
  py::class_<ChooseOptions>(module, "ChooseOptions").def(py::init(&choose_options));
  module.def("embed", &embed_once);
  module.def("embed_best", &embed_chosen);
  module.def("embed_fitted", &embed_with_fitted_cones);
  module.def("choose", &table);
  module.def("distortion_floor", &floor_of);
}

}  // namespace orbitutte::python
