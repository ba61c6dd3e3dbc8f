// SPDX-License-Identifier: MIT
#include "orbitutte/render/render.h"

#include <pybind11/stl.h>

#include "arrays.h"
#include "held_embedding.h"

namespace orbitutte::python {
namespace {

RenderOptions options_from(const std::map<std::string, std::string>& texts, const Surface& surface) {
  RenderOptions options;
  if (const auto panel = texts.find("panel"); panel != texts.end())
    options.panel = parse_choice<Panel>(panel->second, "panel");
  if (const auto size = texts.find("size"); size != texts.end()) parse_picture_size(size->second, options);
  if (const auto up = texts.find("up"); up != texts.end()) options.up = parse_up_direction(up->second);
  if (const auto view = texts.find("view"); view != texts.end())
    options.view =
        parse_view_direction(view->second, options.up ? *options.up : default_up_direction(surface));
  return options;
}

void render(const HeldEmbedding& held, const std::string& path, const std::string& title,
            const std::map<std::string, std::string>& texts) {
  const std::shared_ptr<const Surface> surface = held.source("a picture").surface();
  write_picture(path, {*surface, held.embedding, parse_report(held.brief_report()), title},
                options_from(texts, *surface));
}

}  // namespace

void bind_render(py::module_& module) {
  module.def("render", &render, py::call_guard<py::gil_scoped_release>());
}

}  // namespace orbitutte::python
