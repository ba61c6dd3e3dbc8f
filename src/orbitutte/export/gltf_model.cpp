// SPDX-License-Identifier: MIT
// Uses tinygltf.
#include "orbitutte/export/gltf_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "orbitutte/io/bytes.h"
#include "orbitutte/io/gltf_library.h"

namespace orbitutte {

struct GltfModel::State {
  tinygltf::Model model;
  tinygltf::Mesh mesh;
  std::string bytes;  // of the buffer

  // A view of all bytes from `start` on. A stride of 0 means none.
  int add_view(std::size_t start, std::size_t stride, int target) {
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = start;
    view.byteLength = bytes.size() - start;
    view.byteStride = stride;
    view.target = target;
    model.bufferViews.push_back(view);
    return static_cast<int>(model.bufferViews.size()) - 1;
  }

  tinygltf::Accessor& add_accessor(int view, std::size_t count, int component, int type) {
    tinygltf::Accessor accessor;
    accessor.bufferView = view;
    accessor.byteOffset = 0;
    accessor.normalized = false;
    accessor.componentType = component;
    accessor.count = count;
    accessor.type = type;
    model.accessors.push_back(accessor);
    return model.accessors.back();
  }

  // Numbers for animations.
  int add_scalars(const std::vector<float>& values) {
    const std::size_t start = bytes.size();
    for (const float value : values) append_little_endian(bytes, value);
    const int view = add_view(start, 0, 0);
    tinygltf::Accessor& accessor =
        add_accessor(view, values.size(), TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_SCALAR);
    accessor.minValues = {*std::min_element(values.begin(), values.end())};
    accessor.maxValues = {*std::max_element(values.begin(), values.end())};
    return last_accessor();
  }

  int last_accessor() const { return static_cast<int>(model.accessors.size()) - 1; }
};

GltfModel::GltfModel() : state_(std::make_unique<State>()) {
  state_->model.asset.version = "2.0";
  state_->model.asset.generator = "orbitutte";
}

GltfModel::~GltfModel() = default;

int GltfModel::add_positions(const Points& V) {
  const int index = add_vectors(V);
  tinygltf::Accessor& accessor = state_->model.accessors[index];
  // Rounding is monotone, so the bounds of the rounded numbers are the rounded bounds.
  for (int k = 0; k < 3; ++k) {
    accessor.minValues.push_back(static_cast<float>(V.col(k).minCoeff()));
    accessor.maxValues.push_back(static_cast<float>(V.col(k).maxCoeff()));
  }
  return index;
}

int GltfModel::add_vectors(const Points& N) {
  const std::size_t start = state_->bytes.size();
  for (const auto& p : N.rowwise())
    append_little_endian(state_->bytes, static_cast<float>(p[0]), static_cast<float>(p[1]),
                         static_cast<float>(p[2]));
  const int view = state_->add_view(start, 3 * sizeof(float), TINYGLTF_TARGET_ARRAY_BUFFER);
  state_->add_accessor(view, N.rows(), TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
  return state_->last_accessor();
}

int GltfModel::add_texture_coordinates(const Eigen::MatrixX2d& coordinates) {
  const std::size_t start = state_->bytes.size();
  for (const auto& p : coordinates.rowwise())
    append_little_endian(state_->bytes, static_cast<float>(p[0]), static_cast<float>(1 - p[1]));
  const int view = state_->add_view(start, 2 * sizeof(float), TINYGLTF_TARGET_ARRAY_BUFFER);
  state_->add_accessor(view, coordinates.rows(), TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC2);
  return state_->last_accessor();
}

int GltfModel::add_colours(const std::vector<Rgb>& colours) {
  const std::size_t start = state_->bytes.size();
  const auto channel = [](std::uint8_t c) {
    return static_cast<std::uint16_t>(std::lround(65535 * linear_channel(c)));
  };
  for (const Rgb& c : colours)
    append_little_endian(state_->bytes, channel(c.red), channel(c.green), channel(c.blue),
                         std::uint16_t{65535});
  const int view = state_->add_view(start, 4 * sizeof(std::uint16_t), TINYGLTF_TARGET_ARRAY_BUFFER);
  state_->add_accessor(view, colours.size(), TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4)
      .normalized = true;
  return state_->last_accessor();
}

int GltfModel::add_triangles(const std::vector<std::uint32_t>& indices) {
  const std::size_t start = state_->bytes.size();
  for (const std::uint32_t index : indices) append_little_endian(state_->bytes, index);
  const int view = state_->add_view(start, 0, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
  state_->add_accessor(view, indices.size(), TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR);
  return state_->last_accessor();
}

int GltfModel::add_material(const std::string& name, const Rgb& colour, Sides sides) {
  tinygltf::Material material;
  material.name = name;
  material.pbrMetallicRoughness.baseColorFactor = {linear_channel(colour.red), linear_channel(colour.green),
                                                   linear_channel(colour.blue), 1.0};
  material.pbrMetallicRoughness.metallicFactor = 0.0;
  material.pbrMetallicRoughness.roughnessFactor = 0.7;
  material.doubleSided = sides == Sides::both;
  state_->model.materials.push_back(material);
  return static_cast<int>(state_->model.materials.size()) - 1;
}

void GltfModel::add_primitive(const std::map<std::string, int>& attributes, int indices, int material) {
  tinygltf::Primitive primitive;
  primitive.attributes = attributes;
  primitive.indices = indices;
  primitive.material = material;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  state_->mesh.primitives.push_back(primitive);
}

void GltfModel::add_morph_target(const std::map<std::string, int>& displacements) {
  state_->mesh.primitives.back().targets.push_back(displacements);
  state_->mesh.weights.push_back(0);
}

void GltfModel::animate_morph(const std::vector<float>& times, const std::vector<float>& weights) {
  tinygltf::AnimationSampler sampler;
  sampler.input = state_->add_scalars(times);
  sampler.output = state_->add_scalars(weights);
  sampler.interpolation = "LINEAR";
  tinygltf::AnimationChannel channel;
  channel.sampler = 0;
  channel.target_node = 0;
  channel.target_path = "weights";
  tinygltf::Animation animation;
  animation.samplers.push_back(sampler);
  animation.channels.push_back(channel);
  state_->model.animations.push_back(animation);
}

std::string GltfModel::bytes() const {
  tinygltf::Model model = state_->model;
  model.meshes.push_back(state_->mesh);
  tinygltf::Node node;
  node.mesh = 0;
  model.nodes.push_back(node);
  tinygltf::Scene scene;
  scene.nodes = {0};
  model.scenes.push_back(scene);
  model.defaultScene = 0;
  model.buffers.resize(1);
  model.buffers[0].data.assign(state_->bytes.begin(), state_->bytes.end());
  std::ostringstream stream;
  tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, stream, false, true);
  return std::move(stream).str();
}

double linear_channel(std::uint8_t channel) {
  const double s = channel / 255.0;
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

void check_glb_size(std::size_t bytes, const std::string& what) {
  // Everything besides the mesh stays far below a mebibyte.
  if (bytes > std::numeric_limits<std::uint32_t>::max() - (std::size_t{1} << 20))
    throw ArgumentError(fmt::format("{} is too large for GLB, which holds at most 4 GiB; write .ply", what));
}

}  // namespace orbitutte
