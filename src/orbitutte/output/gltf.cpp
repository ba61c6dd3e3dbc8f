// SPDX-License-Identifier: MIT
// Binary glTF 2.0 (Khronos Group, 2021) through tinygltf, whose implementation is compiled here alone.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <utility>

#include "orbitutte/mesh/bytes.h"
#include "orbitutte/output/tiling_files.h"

namespace orbitutte {
namespace {

constexpr std::size_t position_size = 3 * sizeof(float);
constexpr std::size_t triangle_size = 3 * sizeof(std::uint32_t);

/// All lengths in a GLB are 32-bit numbers; what is not mesh stays far below a mebibyte.
void check_size(const Tiling& tiling) {
  const std::size_t size = position_size * tiling.mesh.V.rows() + triangle_size * tiling.mesh.F.rows();
  if (size > std::numeric_limits<std::uint32_t>::max() - (std::size_t{1} << 20))
    throw ArgumentError("the tiling is too large for GLB, which ends at 4 GiB: write PLY");
}

/// sRGB, 0 .. 255, to the linear scale 0 .. 1 that glTF's factors are on.
double linear(std::uint8_t channel) {
  const double s = channel / 255.0;
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

tinygltf::Material material(const TileMaterial& tile_material) {
  const Rgb& colour = tile_material.colour;
  tinygltf::Material result;
  result.name = tile_material.name;
  result.pbrMetallicRoughness.baseColorFactor = {linear(colour.red), linear(colour.green),
                                                 linear(colour.blue), 1.0};
  result.pbrMetallicRoughness.metallicFactor = 0.0;
  result.pbrMetallicRoughness.roughnessFactor = 0.7;
  result.doubleSided = false;
  return result;
}

tinygltf::Accessor accessor_of(int view, std::size_t count, int component, int type) {
  tinygltf::Accessor accessor;
  accessor.bufferView = view;
  accessor.byteOffset = 0;
  accessor.normalized = false;
  accessor.componentType = component;
  accessor.count = count;
  accessor.type = type;
  return accessor;
}

/// A model of one mesh and one buffer, whose bytes are gathered until the model is complete.
class GltfBuilder {
 public:
  explicit GltfBuilder(const Tiling& tiling) : tiling_(tiling), materials_(tile_materials(tiling)) {
    model_.asset.version = "2.0";
    model_.asset.generator = "orbitutte";
  }

  tinygltf::Model build() {
    bytes_.reserve(position_size * tiling_.mesh.V.rows() + triangle_size * tiling_.mesh.F.rows());
    const std::map<std::string, int> vertices = add_vertices();
    tinygltf::Mesh mesh;
    for (int m = 0; m < static_cast<int>(materials_.materials.size()); ++m) {
      model_.materials.push_back(material(materials_.materials[m]));
      tinygltf::Primitive primitive;
      primitive.attributes = vertices;
      primitive.indices = add_triangles(m);
      primitive.material = m;
      primitive.mode = TINYGLTF_MODE_TRIANGLES;
      mesh.primitives.push_back(primitive);
    }
    add_scene(mesh);
    model_.buffers.resize(1);
    model_.buffers[0].data.assign(bytes_.begin(), bytes_.end());
    return std::move(model_);
  }

 private:
  /// POSITION and NORMAL. A point of the unit sphere is its own normal, so that both read the same bytes.
  std::map<std::string, int> add_vertices() {
    const Points& V = tiling_.mesh.V;
    for (Eigen::Index v = 0; v < V.rows(); ++v)
      for (int k = 0; k < 3; ++k) append_little_endian(bytes_, static_cast<float>(V(v, k)));
    const int view = add_view(0, position_size, TINYGLTF_TARGET_ARRAY_BUFFER);

    auto accessor = accessor_of(view, V.rows(), TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
    for (int k = 0; k < 3; ++k) {  // rounding is monotone: the bounds of the rounded are the rounded bounds
      accessor.minValues.push_back(static_cast<float>(V.col(k).minCoeff()));
      accessor.maxValues.push_back(static_cast<float>(V.col(k).maxCoeff()));
    }
    const int position = add_accessor(accessor);
    const int normal = add_accessor(accessor);
    return {{"POSITION", position}, {"NORMAL", normal}};
  }

  /// The triangles of one colour, as an accessor of vertex indices.
  int add_triangles(int wanted) {
    const std::size_t start = bytes_.size();
    const Faces& F = tiling_.mesh.F;
    for (Eigen::Index f = 0; f < F.rows(); ++f) {
      if (materials_.of_tile[tiling_.tile[f]] != wanted) continue;
      for (int k = 0; k < 3; ++k) append_little_endian(bytes_, static_cast<std::uint32_t>(F(f, k)));
    }
    const int view = add_view(start, 0, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    return add_accessor(accessor_of(view, (bytes_.size() - start) / sizeof(std::uint32_t),
                                    TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR));
  }

  /// A view of all bytes from `start` on. A stride of 0 stands for none.
  int add_view(std::size_t start, std::size_t stride, int target) {
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = start;
    view.byteLength = bytes_.size() - start;
    view.byteStride = stride;
    view.target = target;
    model_.bufferViews.push_back(view);
    return static_cast<int>(model_.bufferViews.size()) - 1;
  }

  int add_accessor(const tinygltf::Accessor& accessor) {
    model_.accessors.push_back(accessor);
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  void add_scene(const tinygltf::Mesh& mesh) {
    model_.meshes.push_back(mesh);
    tinygltf::Node node;
    node.mesh = 0;
    model_.nodes.push_back(node);
    tinygltf::Scene scene;
    scene.nodes = {0};
    model_.scenes.push_back(scene);
    model_.defaultScene = 0;
  }

  const Tiling& tiling_;
  const TileMaterials materials_;
  tinygltf::Model model_;
  std::string bytes_;
};

}  // namespace

std::string glb_bytes(const Tiling& tiling) {
  check_size(tiling);
  const tinygltf::Model model = GltfBuilder(tiling).build();
  std::ostringstream stream;
  tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, stream, false, true);
  return std::move(stream).str();
}

}  // namespace orbitutte
