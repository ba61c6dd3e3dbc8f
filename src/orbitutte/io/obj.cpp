// SPDX-License-Identifier: MIT
// Wavefront OBJ, after Alias|Wavefront, "Advanced Visualizer Manual", appendix B1.
#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>

#include "orbitutte/io/mesh_formats.h"
#include "orbitutte/io/obj_lines.h"
#include "orbitutte/io/text_colours.h"
#include "orbitutte/io/text_scanner.h"

namespace orbitutte {

namespace {

constexpr TextScanner::Syntax obj_syntax = {.comment = '#', .backslash_continues = true};

/// Three numbers after the coordinates are a colour, and one is a weight. Programs do not agree on what more
/// than three are.
bool are_colour(const NextWords& words) { return !words[1].empty() && words[3].empty(); }

void read_vertex(TextScanner& in, std::vector<double>& coordinates, TextColours& colours) {
  const TextItem vertex = {"vertex", coordinates.size() / 3};
  for (int axis = 0; axis < 3; ++axis) coordinates.push_back(in.number<double>(vertex, "coordinate"));
  const NextWords further = take_next_words(in);
  if (are_colour(further)) colours.add(in, vertex, further);
}

/// The part vt, /vn or vt/vn of a corner: up to two indices, each of which may be left out.
bool is_texture_and_normal(std::string_view part) {
  const std::size_t slash = part.find('/');
  const std::string_view texture = part.substr(0, slash);
  const std::string_view normal = slash == part.npos ? std::string_view() : part.substr(slash + 1);
  const auto is_index = [](std::string_view word) {
    long long index;
    return word.empty() || parse_number(word, index) == NumberError::none;
  };
  return is_index(texture) && is_index(normal);
}

/// The index v of a corner v, v/vt, v//vn or v/vt/vn.
long long index_of_corner(const TextScanner& in, const TextItem& face, std::string_view corner) {
  const std::size_t slash = corner.find('/');
  long long index = 0;
  const NumberError error = parse_number(corner.substr(0, slash), index);
  if (error != NumberError::none) in.refuse_number(error, true, corner, face, "index");
  if (slash != corner.npos && !is_texture_and_normal(corner.substr(slash + 1))) {
    in.refuse(fmt::format("face {} has the corner {}, which is none of v, v/vt, v//vn, v/vt/vn", face.number,
                          in_quotes(corner)));
  }
  if (index > std::numeric_limits<int>::max() + 1LL) {
    in.refuse_number(NumberError::out_of_range, true, corner, face, "index");
  }
  return index;
}

/// The 0-based vertex of an index, which counts from 1, or back from the latest of the `vertices` read so far
/// if it is negative.
int vertex_of_index(const TextScanner& in, const TextItem& face, long long index, std::size_t vertices) {
  if (index == 0) in.refuse(fmt::format("face {} has the index 0, but OBJ counts from 1", face.number));
  const long long vertex = index > 0 ? index - 1 : static_cast<long long>(vertices) + index;
  if (vertex >= 0) return static_cast<int>(vertex);
  in.refuse(fmt::format("face {} has the index {}, but only {} vertices come before it", face.number, index,
                        vertices));
}

int read_corner(TextScanner& in, const TextItem& face, std::size_t vertices) {
  int index = 0;
  if (in.take_plain_number(index)) return vertex_of_index(in, face, index, vertices);
  return vertex_of_index(in, face, index_of_corner(in, face, in.word()), vertices);
}

void read_face(TextScanner& in, std::size_t vertices, PolygonMesh& mesh) {
  const TextItem face = {"face", mesh.face_start.size() - 1};
  while (in.find_word_in_line()) mesh.corners.push_back(read_corner(in, face, vertices));
  end_face(mesh);
}

/// Makes room for a vertex for every line that begins with `v`, and for a triangle for every line that
/// begins with `f`. Arrays that grow are copied, and take twice the memory meanwhile.
void make_room(std::string_view text, std::vector<double>& coordinates, PolygonMesh& mesh) {
  std::size_t vertices = 0, faces = 0;
  for (std::string_view rest = text; !rest.empty();
       rest.remove_prefix(std::min(rest.find('\n'), rest.size() - 1) + 1)) {
    vertices += rest.starts_with("v ");
    faces += rest.starts_with("f ");
  }
  coordinates.reserve(3 * vertices);
  mesh.corners.reserve(3 * faces);
  mesh.face_start.reserve(faces + 1);
}

}  // namespace

PolygonMesh read_obj(std::string_view text) {
  PolygonMesh mesh;
  std::vector<double> coordinates;
  TextColours colours;
  make_room(text, coordinates, mesh);
  TextScanner in(text, obj_syntax);
  while (in.find_word()) {
    const std::string_view keyword = in.word();
    if (keyword == "v") {
      read_vertex(in, coordinates, colours);
    } else if (keyword == "f") {
      read_face(in, coordinates.size() / 3, mesh);
    } else {
      in.rest_of_line();  // not skip_words: names of materials may end with a backslash
    }
  }
  if (coordinates.empty()) {
    throw MeshError("no line begins with 'v', so there are no vertices; check that it is an OBJ file");
  }
  mesh.V = to_points(coordinates);
  give_colours(colours.colours(mesh.V.rows()), mesh);
  return mesh;
}

void append_obj_vertices(const Points& points, std::string& text) {
  const auto out = std::back_inserter(text);
  for (const auto& position : points.rowwise())
    fmt::format_to(out, FMT_COMPILE("v {} {} {}\n"), position[0], position[1], position[2]);
}

void append_textured_obj(const Surface& surface, const TextureLayout& layout, std::string& text) {
  append_obj_vertices(surface.V, text);
  const auto out = std::back_inserter(text);
  for (const auto& p : layout.uv.rowwise()) fmt::format_to(out, FMT_COMPILE("vt {} {}\n"), p[0], p[1]);
  const FaceView faces = surface.faces();
  for (int f = 0; f < faces.count(); ++f) {
    text += 'f';
    for (int k = 0; k < faces.degree(f); ++k)
      fmt::format_to(out, FMT_COMPILE(" {}/{}"), faces[f][k] + 1LL,
                     layout.of_corner[faces.start(f) + k] + 1LL);
    text += '\n';
  }
}

std::string write_obj(const Mesh& mesh) {
  std::string text = room_for_text(mesh);
  append_obj_vertices(mesh.V, text);
  const auto out = std::back_inserter(text);
  for (const auto& face : mesh.F.rowwise()) {
    fmt::format_to(out, FMT_COMPILE("f {} {} {}\n"), face[0] + 1LL, face[1] + 1LL, face[2] + 1LL);
  }
  return text;
}

}  // namespace orbitutte
