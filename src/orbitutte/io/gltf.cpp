// SPDX-License-Identifier: MIT
// glTF 2.0, by tinygltf: the triangles of all meshes, as text (.gltf) or binary (.glb). Vertices are the same
// where primitives name the same accessor of positions.
#define TINYGLTF_IMPLEMENTATION
#include "orbitutte/io/gltf_library.h"
#undef TINYGLTF_IMPLEMENTATION

#include <fmt/format.h>

#include <map>

#include "orbitutte/io/base64.h"
#include "orbitutte/io/bytes.h"
#include "orbitutte/io/mesh_formats.h"
#include "orbitutte/io/number_types.h"
#include "orbitutte/io/text_scanner.h"

namespace orbitutte {
namespace {

// tinygltf asks for other files through these functions: none of them looks at the disk.
bool refuse_to_find(const std::string& path, void* name) {
  auto& first = *static_cast<std::string*>(name);
  if (first.empty()) first = path;
  return false;
}
std::string same_path(const std::string& path, void* /*name*/) { return path; }
bool refuse_to_read(std::vector<unsigned char>* /*bytes*/, std::string* /*error*/,
                    const std::string& /*path*/, void* /*name*/) {
  return false;
}
bool refuse_to_write(std::string* /*error*/, const std::string& /*path*/,
                     const std::vector<unsigned char>& /*bytes*/, void* /*name*/) {
  return false;
}
bool skip_image(tinygltf::Image* /*image*/, int /*index*/, std::string* /*error*/, std::string* /*warning*/,
                int /*width*/, int /*height*/, const unsigned char* /*bytes*/, int /*size*/, void* /*data*/) {
  return true;
}

bool is_glb(std::string_view bytes) { return bytes.starts_with("glTF"); }

// Throws MeshError.
tinygltf::Model parse_gltf(std::string_view bytes) {
  std::string other_file, error, warning;
  tinygltf::TinyGLTF parser;
  parser.SetFsCallbacks({refuse_to_find, same_path, refuse_to_read, refuse_to_write, &other_file});
  parser.SetImageLoader(skip_image, nullptr);
  tinygltf::Model model;
  checked_count(bytes.size(), "bytes");
  const auto size = static_cast<unsigned>(bytes.size());
  bool is_read = false;
  try {
    is_read = is_glb(bytes)
                  ? parser.LoadBinaryFromMemory(&model, &error, &warning,
                                                reinterpret_cast<const unsigned char*>(bytes.data()), size)
                  : parser.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, std::string());
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& failure) {
    error = failure.what();
  }
  if (is_read) return model;
  if (!other_file.empty())
    throw MeshError(fmt::format("the numbers are in the file {}, which is not read; export it as .glb",
                                in_quotes(other_file)));
  throw MeshError(
      fmt::format("the file is no glTF 2.0: {}; export it again", shown(error.substr(0, error.find('\n')))));
}

const NumberType* component_type(int type) {
  const auto name = [&]() -> std::string_view {
    switch (type) {
      case TINYGLTF_COMPONENT_TYPE_BYTE:
        return "i1";
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return "u1";
      case TINYGLTF_COMPONENT_TYPE_SHORT:
        return "i2";
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return "u2";
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return "u4";
      case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return "f4";
      default:
        return {};
    }
  };
  return find_number_type(&NumberType::npy, name());
}

// Gathers the meshes of a file.
class GltfMeshes {
 public:
  explicit GltfMeshes(const tinygltf::Model& model) : model_(model) {}

  PolygonMesh run() {
    for (std::size_t mesh = 0; mesh < model_.meshes.size(); ++mesh)
      for (const tinygltf::Primitive& primitive : model_.meshes[mesh].primitives)
        add_primitive(primitive, mesh);
    if (!has_triangles_) throw MeshError("the file has no triangles; export the mesh, not only the scene");
    result_.V = to_points(coordinates_);
    warn_of_transforms();
    return std::move(result_);
  }

 private:
  [[noreturn]] static void refuse(int accessor, std::string_view problem) {
    throw MeshError(fmt::format("accessor {}: {}; export the file again", accessor, problem));
  }

  // Numbers of an accessor, 3 for each element of positions, 1 of indices.
  std::vector<double> numbers(int index, int columns) const {
    if (index < 0 || index >= static_cast<int>(model_.accessors.size())) refuse(index, "it does not exist");
    const tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(index)];
    if (accessor.type != (columns == 3 ? TINYGLTF_TYPE_VEC3 : TINYGLTF_TYPE_SCALAR))
      refuse(index, fmt::format("it has elements of another kind than {} numbers", columns));
    if (accessor.sparse.isSparse) refuse(index, "sparse accessors are not read");
    const bool is_index = accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    const NumberType* const type = component_type(accessor.componentType);
    if (!type || (is_index && columns != 1))
      refuse(index, fmt::format("its type {} of numbers is not known", accessor.componentType));
    const std::string_view bytes = bytes_of_view(index, accessor.bufferView);
    const std::size_t element = type->size * static_cast<std::size_t>(columns),
                      given = model_.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride,
                      stride = given > 0 ? given : element;
    if (accessor.byteOffset > bytes.size()) refuse(index, "it begins behind its view");
    const std::string_view rest = bytes.substr(accessor.byteOffset);
    if (accessor.count > 0 &&
        (rest.size() < element || (rest.size() - element) / stride < accessor.count - 1))
      refuse(index, fmt::format("{} elements do not fit into {} bytes", accessor.count, rest.size()));
    std::vector<double> values;
    values.reserve(accessor.count * static_cast<std::size_t>(columns));
    for (std::size_t k = 0; k < accessor.count; ++k)
      for (std::size_t at = k * stride; at < k * stride + element; at += type->size)
        values.push_back(type->load(rest.data() + at, std::endian::little));
    return values;
  }

  // Of an accessor.
  std::string_view bytes_of_view(int accessor, int view_index) const {
    if (view_index < 0 || view_index >= static_cast<int>(model_.bufferViews.size()))
      refuse(accessor, "it has no numbers, as in compressed files, which are not read");
    const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(view_index)];
    if (view.buffer < 0 || view.buffer >= static_cast<int>(model_.buffers.size()))
      refuse(accessor, "its buffer does not exist");
    const std::vector<unsigned char>& bytes = model_.buffers[static_cast<std::size_t>(view.buffer)].data;
    if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset)
      refuse(accessor, "its view lies outside of the buffer");
    return {reinterpret_cast<const char*>(bytes.data()) + view.byteOffset, view.byteLength};
  }

  // Vertices `first` .. `first + count - 1` of the result.
  struct VertexRange {
    int first, count;
  };

  VertexRange vertices_of(int accessor) {
    if (const auto known = ranges_.find(accessor); known != ranges_.end()) return known->second;
    const std::vector<double> values = numbers(accessor, 3);
    const VertexRange range = {checked_count(coordinates_.size() / 3, "vertices"),
                               checked_count(values.size() / 3, "vertices")};
    coordinates_.insert(coordinates_.end(), values.begin(), values.end());
    return ranges_.emplace(accessor, range).first->second;
  }

  std::vector<int> corners_of(const tinygltf::Primitive& primitive, const VertexRange& vertices,
                              std::size_t mesh) const {
    std::vector<int> corners;
    if (primitive.indices < 0) {
      corners.reserve(static_cast<std::size_t>(vertices.count));
      for (int k = 0; k < vertices.count; ++k) corners.push_back(vertices.first + k);
      return corners;
    }
    const std::vector<double> indices = numbers(primitive.indices, 1);
    corners.reserve(indices.size());
    for (const double index : indices) {
      if (!(index >= 0 && index < vertices.count))
        throw MeshError(fmt::format("mesh {} names the vertex {}, but has {}; export the file again", mesh,
                                    index, vertices.count));
      corners.push_back(vertices.first + static_cast<int>(index));
    }
    return corners;
  }

  void add_primitive(const tinygltf::Primitive& primitive, std::size_t mesh) {
    const int mode = primitive.mode;
    if (mode != TINYGLTF_MODE_TRIANGLES && mode != TINYGLTF_MODE_TRIANGLE_STRIP &&
        mode != TINYGLTF_MODE_TRIANGLE_FAN)
      return;
    const auto positions = primitive.attributes.find("POSITION");
    if (positions == primitive.attributes.end()) return;
    const std::vector<int> c = corners_of(primitive, vertices_of(positions->second), mesh);
    const std::size_t step = mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1;
    for (std::size_t k = 0; k + 2 < c.size(); k += step) {
      const std::size_t turn = mode == TINYGLTF_MODE_TRIANGLE_STRIP ? k % 2 : 0;
      if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
        add_triangle(c[0], c[k + 1], c[k + 2]);
      else
        add_triangle(c[k + turn], c[k + 1 - turn], c[k + 2]);
    }
    has_triangles_ = true;
  }

  void add_triangle(int a, int b, int c) {
    result_.corners.insert(result_.corners.end(), {a, b, c});
    end_face(result_);
  }

  void warn_of_transforms() {
    for (const tinygltf::Node& node : model_.nodes)
      if (!node.matrix.empty() || !node.rotation.empty() || !node.scale.empty() ||
          !node.translation.empty()) {
        result_.warnings.emplace_back(
            "the file places its meshes by transforms of nodes, which are not applied: positions are those "
            "of "
            "the meshes");
        return;
      }
  }

  const tinygltf::Model& model_;
  PolygonMesh result_;
  std::vector<double> coordinates_;
  std::map<int, VertexRange> ranges_;  // by accessor
  bool has_triangles_ = false;
};

// What both kinds of files have, but for the entry of the buffer: positions, then indices.
struct GltfText {
  std::string json, buffer;
};

GltfText gltf_of(const Mesh& mesh) {
  GltfText result;
  Eigen::RowVector3f low = Eigen::RowVector3f::Zero(), high = low;
  if (mesh.V.rows() > 0) {
    low = mesh.V.cast<float>().colwise().minCoeff();
    high = mesh.V.cast<float>().colwise().maxCoeff();
  }
  for (const auto& position : mesh.V.rowwise())
    append_little_endian(result.buffer, static_cast<float>(position[0]), static_cast<float>(position[1]),
                         static_cast<float>(position[2]));
  const std::size_t positions = result.buffer.size();
  for (const auto& face : mesh.F.rowwise())
    append_little_endian(result.buffer, static_cast<std::uint32_t>(face[0]),
                         static_cast<std::uint32_t>(face[1]), static_cast<std::uint32_t>(face[2]));
  result.json = fmt::format(
      R"({{"asset":{{"version":"2.0","generator":"orbitutte"}},"scene":0,"scenes":[{{"nodes":[0]}}],)"
      R"("nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],)"
      R"("accessors":[{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3","min":[{},{},{}],"max":[{},{},{}]}},)"
      R"({{"bufferView":1,"componentType":5125,"count":{},"type":"SCALAR"}}],)"
      R"("bufferViews":[{{"buffer":0,"byteLength":{},"target":34962}},)"
      R"({{"buffer":0,"byteOffset":{},"byteLength":{},"target":34963}}],)",
      mesh.V.rows(), low[0], low[1], low[2], high[0], high[1], high[2], mesh.F.size(), positions, positions,
      result.buffer.size() - positions);
  return result;
}

void require_gltf(const Mesh& mesh) {
  constexpr std::size_t most = 0xFFFFFFFF / 16;
  if (static_cast<std::size_t>(mesh.V.rows() + mesh.F.rows()) > most)
    throw MeshError("the mesh is too large for glTF; write .ply");
  if (mesh.V.rows() == 0 || mesh.F.rows() == 0)
    throw MeshError("glTF has no empty meshes; write .obj, .off or .ply");
  if (!mesh.V.allFinite())
    throw MeshError("glTF has no positions that are not finite; write .obj, .off or .ply");
}

}  // namespace

PolygonMesh read_gltf(std::string_view bytes) { return GltfMeshes(parse_gltf(bytes)).run(); }

std::string write_gltf(const Mesh& mesh) {
  require_gltf(mesh);
  const GltfText text = gltf_of(mesh);
  return fmt::format(R"({}"buffers":[{{"byteLength":{},"uri":"data:application/octet-stream;base64,{}"}}]}})",
                     text.json, text.buffer.size(), base64(text.buffer));
}

std::string write_glb(const Mesh& mesh) {
  require_gltf(mesh);
  GltfText text = gltf_of(mesh);
  text.json += fmt::format(R"("buffers":[{{"byteLength":{}}}]}})", text.buffer.size());
  text.json.append((4 - text.json.size() % 4) % 4, ' ');
  constexpr std::uint32_t version = 2, header = 12, chunk_header = 8;
  const auto json_size = static_cast<std::uint32_t>(text.json.size()),
             buffer_size = static_cast<std::uint32_t>(text.buffer.size());
  std::string bytes = "glTF";
  append_little_endian(bytes, version, header + 2 * chunk_header + json_size + buffer_size, json_size);
  bytes += "JSON" + text.json;
  append_little_endian(bytes, buffer_size);
  bytes += std::string_view("BIN\0", 4);
  return bytes + text.buffer;
}

}  // namespace orbitutte
