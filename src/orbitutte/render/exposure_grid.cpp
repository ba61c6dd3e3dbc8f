// SPDX-License-Identifier: MIT
// J. Kopf et al., "Joint Bilateral Upsampling", ACM TOG 26(3), 2007.
#include "orbitutte/render/exposure_grid.h"

#include <algorithm>
#include <cmath>

#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

constexpr int grid_spacing = 3;  // pixels

float fraction(float x) { return x - std::floor(x); }

// Interleaved gradient noise (J. Jimenez, "Next Generation Post Processing in Call of Duty", 2014): a number
// 0 .. 1 for every node that takes all values in every small block of nodes.
float dither(int column, int row) {
  return fraction(52.9829189F *
                  fraction(0.06711056F * static_cast<float>(column) + 0.00583715F * static_cast<float>(row)));
}

// A weighted mean of exposures.
struct ExposureSum {
  float openness = 0, lit = 0, weight = 0;

  void add(float w, const Exposure& exposure) {
    openness += w * exposure.openness;
    lit += w * exposure.lit;
    weight += w;
  }
  Exposure mean() const { return {openness / weight, lit / weight}; }
};

}  // namespace

ExposureGrid::ExposureGrid(const Camera& camera, double distance, LitSurface surface)
    : surface_(std::move(surface)),
      pixel_(static_cast<float>(camera.pixel)),
      columns_((camera.size.width - 1) / grid_spacing + 2),
      rows_((camera.size.height - 1) / grid_spacing + 2),
      nodes_(static_cast<std::size_t>(columns_) * rows_) {
  parallel_for(rows_, [&](int row) { find_row(camera, distance, row); });
  std::vector<Exposure> exposures(nodes_.size());
  parallel_for(rows_, [&](int row) {
    for (int column = 0; column < columns_; ++column)
      exposures[static_cast<std::size_t>(row) * columns_ + column] = smoothed(column, row);
  });
  for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_[i].exposure = exposures[i];
}

void ExposureGrid::find_row(const Camera& camera, double distance, int row) {
  for (int first = 0; first < columns_; first += packet_size) {
    Packet rays;
    for (int k = 0; k < packet_size; ++k)
      rays[k] = camera.ray(static_cast<float>(grid_spacing * (first + k)),
                           static_cast<float>(grid_spacing * row), distance);
    const Normals normals = surface_.seen(rays);
    for (int k = 0; k < std::min(packet_size, columns_ - first); ++k)
      if (normals[k])
        nodes_[static_cast<std::size_t>(row) * columns_ + first + k] = {
            normals[k]->origin, normals[k]->direction,
            surface_.exposure(*normals[k], dither(first + k, row))};
  }
}

// 0 .. 1: whether a node lies in the tangent plane of a point and has the same normal.
float ExposureGrid::likeness(const Node& node, const Vector3f& origin, const Vector3f& normal) const {
  constexpr float farthest = 4;  // pixels
  const float height = std::abs(normal.dot(node.origin - origin)) / (farthest * pixel_);
  return std::max(0.0F, 1 - height) * std::max(0.0F, 5 * normal.dot(node.normal) - 4);
}

// Over the nodes around.
Exposure ExposureGrid::smoothed(int column, int row) const {
  constexpr int reach = 1;
  const Node& middle = node(column, row);
  if (middle.normal.isZero(0)) return {};
  ExposureSum sum;
  for (int j = std::max(0, row - reach); j <= std::min(rows_ - 1, row + reach); ++j)
    for (int i = std::max(0, column - reach); i <= std::min(columns_ - 1, column + reach); ++i) {
      const float near =
          static_cast<float>((reach + 1 - std::abs(i - column)) * (reach + 1 - std::abs(j - row)));
      sum.add(near * likeness(node(i, j), middle.origin, middle.normal), node(i, j).exposure);
    }
  return sum.mean();
}

Exposure ExposureGrid::at(int column, int row, const Ray& normal) const {
  constexpr float enough = 0.05F;
  const auto nearness = [](int pixel, int node) {
    return 1 - std::abs((static_cast<float>(pixel) + 0.5F) / grid_spacing - static_cast<float>(node));
  };
  const int left = column / grid_spacing, top = row / grid_spacing;
  ExposureSum sum;
  for (int j = top; j <= top + 1; ++j)
    for (int i = left; i <= left + 1; ++i)
      sum.add(nearness(column, i) * nearness(row, j) * likeness(node(i, j), normal.origin, normal.direction),
              node(i, j).exposure);
  return sum.weight > enough ? sum.mean() : surface_.exposure(normal, dither(column, row));
}

}  // namespace orbitutte
