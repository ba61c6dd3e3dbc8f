// SPDX-License-Identifier: MIT
// Stands in for render_command.cpp if the library is built without Embree and Cairo.
#include "commands.h"
#include "map_products.h"
#include "orbitutte/types.h"
#include "page_pictures.h"

namespace orbitutte::cli {

namespace {

constexpr const char* no_pictures =
    "this binary was built without pictures; build it with -D ORBITUTTE_RENDER=ON";

}  // namespace

int render_command(const RenderArguments&) { throw ArgumentError(no_pictures); }

Viewpoint parse_viewpoint(const std::string& view, const std::string& up, const Surface&) {
  if (!view.empty() || !up.empty()) throw ArgumentError(no_pictures);
  return {};
}

void write_scale_picture(const std::string&, const Surface&, const Embedding&, const std::vector<int>&) {
  throw ArgumentError(no_pictures);
}

void require_pictures(const std::string&, const std::string&) { throw ArgumentError(no_pictures); }

std::string map_picture(const MapArguments&, const MappedSurfaces&) { throw ArgumentError(no_pictures); }

std::vector<PagePicture> page_pictures(const Surface&, const Embedding&, const Report&) { return {}; }

}  // namespace orbitutte::cli
