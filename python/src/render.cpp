// SPDX-License-Identifier: MIT
#include "orbitutte/render/render.h"

#include <pybind11/stl.h>

#include "arrays.h"
#include "held_embedding.h"

namespace orbitutte::python {
namespace {

RenderOptions options_from(const std::map<std::string, std::string>& texts, const Mesh& mesh) {
  RenderOptions options;
  if (const auto panel = texts.find("panel"); panel != texts.end())
    options.panel = parse_panel(panel->second);
  if (const auto size = texts.find("size"); size != texts.end()) parse_size(size->second, options);
  if (const auto up = texts.find("up"); up != texts.end()) options.up = parse_up(up->second);
  if (const auto view = texts.find("view"); view != texts.end())
    options.view = parse_view(view->second, options.up ? *options.up : default_up(mesh));
  return options;
}

void render(const HeldEmbedding& held, const std::string& path, const std::string& title,
            const std::map<std::string, std::string>& texts) {
  const Mesh& mesh = held.source("a picture").triangles();
  write_picture(path, {mesh, held.embedding, parse_report(held.report), title}, options_from(texts, mesh));
}

}  // namespace

void bind_render(py::module_& module) {
  module.def("render", &render, py::call_guard<py::gil_scoped_release>());
}

}  // namespace orbitutte::python
